// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "soilModel.C"
#include "linearElastic.C"
#include "rigidSkeleton.C"
#include "granularModel.C"
#include "DruckerPrager.C"
#include "muI.C"
#include "elastoplasticMuI.C"
#include "adaptiveSubstepping.C"
