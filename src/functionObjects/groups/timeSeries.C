// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "cloudFunctionObject.C"
#include "cloudTimeSeries.C"
#include "materialPointEnergy.C"
#include "massBalance.C"
#include "frontPosition.C"
#include "pressureSet.C"
#include "materialPointForces.C"
