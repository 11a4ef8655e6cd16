// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "pointHistory.C"
#include "materialPointHDF5.C"
