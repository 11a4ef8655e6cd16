// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "../soilModel/soilModel/soilModel.C"
#include "../soilModel/linearElastic/linearElastic.C"
#include "../soilModel/rigidSkeleton/rigidSkeleton.C"
#include "../soilModel/granularModel/granularModel.C"
#include "../soilModel/DruckerPrager/DruckerPrager.C"
#include "../soilModel/muI/muI.C"
#include "../soilModel/elastoplasticMuI/elastoplasticMuI.C"
#include "../soilModel/adaptiveSubstepping/adaptiveSubstepping.C"
