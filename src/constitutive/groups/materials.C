// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "../dictionaryEntries/dictionaryEntries.C"
#include "../phaseRole/phaseRole.C"
#include "../weaklyCompressibleNewtonian/weaklyCompressibleNewtonian.C"
#include "../granularElasticity/granularElasticity.C"
#include "../criticalState/criticalState.C"
#include "../muIRheology/muIRheology.C"
#include "../denseSuspension/denseSuspension.C"
#include "../elementTest/elementTest.C"
