// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "gaugeWeights.C"
#include "gridVolume.C"
#include "waveGauge.C"
