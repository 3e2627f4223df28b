#pragma once
// Finds the delays, rates and amplitudes of echoes at the window centre of a chirp.
#include <cstdint>

namespace echopath {

struct Echoes;

struct EchoStates {
  static constexpr int kCapacity = 256;         // delays, amplitudes and carriers of a block stay in the first-level cache
  alignas(64) double delay[kCapacity];          // s
  alignas(64) double rate[kCapacity];           // s/s
  alignas(64) double amplitude[2 * kCapacity];  // sqrt(W), re, im interleaved
};

// Holds the second and third derivatives of the delays, in 1/s and 1/s^2.
struct EchoDerivatives {
  alignas(64) double second[EchoStates::kCapacity];
  alignas(64) double third[EchoStates::kCapacity];
};

// Evaluates echoes [begin, begin + count), count <= kCapacity, at chirps [chirp, chirp + num_chirps): states [num_chirps].
// It costs least where neighbouring chirps share their nodes.
void evaluate_states(const Echoes& echoes, int chirp, int num_chirps, int64_t begin, int count, EchoStates* states);
// Evaluates these echoes at one chirp. `derivatives` may be null; they are zero where the sampling has none.
void evaluate_states(const Echoes& echoes, int chirp, int64_t begin, int count, EchoStates& states,
                     EchoDerivatives* derivatives = nullptr);

}  // namespace echopath
