// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "../scourProfile/columnSurfaces.C"
#include "../bedTimeSeries/bedTimeSeries.C"
#include "../scourProfile/scourProfile.C"
#include "../erosionCriteria/erosionCriteria.C"
