// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "waitingZone.C"
#include "inlet.C"
#include "outlet.C"
#include "patchOutlet.C"
#include "limitOutlet.C"
#include "regionOutlet.C"
#include "inflowOutflow.C"
