// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "dictionaryEntries.C"
#include "phaseRole.C"
#include "weaklyCompressibleNewtonian.C"
#include "granularElasticity.C"
#include "criticalState.C"
#include "muIRheology.C"
#include "denseSuspension.C"
#include "elementTest.C"
