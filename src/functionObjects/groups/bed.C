// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "columnSurfaces.C"
#include "bedTimeSeries.C"
#include "scourProfile.C"
#include "erosionCriteria.C"
