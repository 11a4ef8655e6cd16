// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "../materialPointHDF5/pointHistory.C"
#include "../materialPointHDF5/materialPointHDF5.C"
