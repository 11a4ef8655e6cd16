// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "../materialPointCloud/materialPointCloud.C"
#include "../materialPointCloud/materialPointCloudMove.C"
#include "../materialPointCloud/materialPointCloudIO.C"
#include "../closedBasins/closedBasins.C"
#include "../waterCloud/waterCloud.C"
#include "../soilCloud/skeleton.C"
#include "../soilCloud/soilCloud.C"
