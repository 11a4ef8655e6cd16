// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "../inflowOutflow/waitingZone/waitingZone.C"
#include "../inflowOutflow/inlet/inlet.C"
#include "../inflowOutflow/outlet/outlet/outlet.C"
#include "../inflowOutflow/outlet/patch/patchOutlet.C"
#include "../inflowOutflow/outlet/limit/limitOutlet.C"
#include "../inflowOutflow/outlet/region/regionOutlet.C"
#include "../inflowOutflow/inflowOutflow/inflowOutflow.C"
