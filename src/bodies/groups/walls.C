// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "bodyNodes.C"
#include "bodyWall.C"
#include "bodyContact.C"
