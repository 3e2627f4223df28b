#pragma once
// Synthesises echoes that polynomials give over a frame, without scene, rays and replay.
#include <complex>
#include <vector>

#include "echopath/signal/synthesizer.h"

namespace echopath {

// Returns the times (s) of the nodes of a frame that starts at 0: Chebyshev-Lobatto nodes, or one for echoes at rest.
std::vector<double> trial_node_times(const ChirpSequence& waveform, int num_nodes);

// Makes echoes from delay (s) and amplitude (sqrt(W)), [num_nodes, num_echoes] at trial_node_times. Raises invalid_argument
// unless they are of that size.
Echoes trial_echoes(const ChirpSequence& waveform, int num_nodes, std::vector<double> delay,
                    std::vector<std::complex<double>> amplitude);

struct SynthesisTrial {
  std::vector<std::complex<double>> samples;  // [chirp, sample] sqrt(W)
  double elapsed = 0.0, processor = 0.0;      // s: by the clock, and of all processors together
};

// Raises what Synthesizer does.
SynthesisTrial try_synthesis(const ChirpSequence& waveform, const Echoes& echoes, const SynthesisOptions& options, Job* job);

}  // namespace echopath
