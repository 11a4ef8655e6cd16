// Compiled as one, as headers take most of the time: see CONTRIBUTING.md
#include "../waveGauge/gaugeWeights.C"
#include "../waveGauge/gridVolume.C"
#include "../waveGauge/waveGauge.C"
