#include "echopath/bench/synthesis_trial.h"

#include <utility>

#include "echopath/base/errors.h"
#include "echopath/bench/stopwatch.h"
#include "echopath/replay/time/frame_nodes.h"

namespace echopath {
namespace {

FrameNodes trial_nodes(const ChirpSequence& waveform, int num_nodes) {
  Radar radar;
  radar.waveform = waveform;
  radar.transmitters.resize(1);
  radar.receivers.resize(1);
  return num_nodes == 1 ? static_nodes(radar, 0.0) : chebyshev_nodes(radar, 0.0, {}, num_nodes);
}

}  // namespace

std::vector<double> trial_node_times(const ChirpSequence& waveform, int num_nodes) {
  require(num_nodes >= 1, "num_nodes", "must be at least 1", num_nodes);
  return trial_nodes(waveform, num_nodes).times;
}

Echoes trial_echoes(const ChirpSequence& waveform, int num_nodes, std::vector<double> delay,
                    std::vector<std::complex<double>> amplitude) {
  require(num_nodes >= 1 && std::ssize(delay) % num_nodes == 0, "delays", "must have one row a node, rows", num_nodes);
  require(amplitude.size() == delay.size(), "amplitudes", "must have the shape of delays, values", amplitude.size());
  Echoes echoes;
  echoes.sampling = trial_nodes(waveform, num_nodes).sampling.front();
  echoes.num_echoes = std::ssize(delay) / num_nodes;
  echoes.delay = std::move(delay);
  echoes.amplitude = std::move(amplitude);
  return echoes;
}

SynthesisTrial try_synthesis(const ChirpSequence& waveform, const Echoes& echoes, const SynthesisOptions& options,
                             Job* job) {
  SynthesisTrial trial;
  const Stopwatch watch;
  Synthesizer synthesizer(waveform, 1, 1, echoes.num_echoes, options);
  synthesizer.add(0, echoes, job);
  trial.samples = synthesizer.cube(0, job);
  trial.elapsed = watch.elapsed();
  trial.processor = watch.processor();
  return trial;
}

}  // namespace echopath
