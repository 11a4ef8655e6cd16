// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "materialPointCloud.C"
#include "materialPointCloudMove.C"
#include "materialPointCloudIO.C"
#include "closedBasins.C"
#include "waterCloud.C"
#include "skeleton.C"
#include "soilCloud.C"
