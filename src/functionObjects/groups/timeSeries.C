// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "../cloudFunctionObject/cloudFunctionObject.C"
#include "../cloudTimeSeries/cloudTimeSeries.C"
#include "../materialPointEnergy/materialPointEnergy.C"
#include "../massBalance/massBalance.C"
#include "../frontPosition/frontPosition.C"
#include "../materialPointForces/pressureSet.C"
#include "../materialPointForces/materialPointForces.C"
