// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "../bodyNodes/bodyNodes.C"
#include "../bodyWall/bodyWall.C"
#include "../bodyContact/bodyContact.C"
