#pragma once
// Follows single echoes from chirp to chirp, for what cells of a map have of those whose phase is no parabola over the
// frame.
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"

namespace echopath {

// Holds the signal of N echoes between the first antennas at T times, rows of T.
struct EchoHistories {
  std::vector<std::complex<float>> field;  // [N, T] in the middle of the samples, over the largest of the echo
  std::vector<float> farther;              // [N, T] m, by which the length is larger than at `middle`
  std::vector<double> largest;             // [N] sqrt(W)
};

// Returns those of some paths (indices) at `times` (s). Raises Cancelled when the job is cancelled.
EchoHistories echo_histories(const Paths& paths, std::span<const int64_t> some, std::span<const double> times, double middle,
                             Job* job = nullptr);

// Returns the sums over a row of `table` [N, T] with each of some weights [W, T], [W, rows]. Each has the same bits whatever
// the other rows and the number of threads.
std::vector<std::complex<float>> weighted_row_sums(std::span<const std::complex<float>> table, std::span<const int32_t> rows,
                                                   std::span<const std::complex<float>> weights, size_t num_times);

}  // namespace echopath
