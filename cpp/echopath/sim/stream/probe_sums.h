#pragma once
// Holds the sums that a probe of a pass keeps of its echoes.
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "echopath/signal/echoes/echo_states.h"
#include "echopath/signal/kernels/carrier.h"
#include "echopath/sim/stream/signal_probe.h"

namespace echopath {

// Holds sums of samples, or the offsets of these in samples from the first of the chirp.
using SampleSums = std::array<double, ProbedChirp::kSamples>;

// Holds the samples of a row, real parts first.
struct SampleRow {
  static constexpr int kSamples = ProbedChirp::kSamples;
  SampleSums re{}, im{};
};

// Holds sums over some echoes, in kLanes sums side by side.
struct EchoPowerSums {
  static constexpr int kLanes = 8;
  double power[kLanes] = {}, root[kLanes] = {}, largest[kLanes] = {};
};

// Computes the powers of the first `count` echoes, W, and their sums. `power` has room for EchoStates::kCapacity.
EchoPowerSums powers_of(EchoStates& states, int count, double* power);

// Keeps the few strongest of the echoes that are shown to it, strongest first.
class StrongestEchoes {
 public:
  static constexpr size_t kCount = 4;
  // `largest` is the largest of these powers, W.
  void show(const double* power, double largest, int64_t first, int count) {
    if (largest <= best_.back().first) return;
    for (int p = 0; p < count; ++p) {
      if (power[p] > best_.back().first) insert(power[p], first + p);
    }
  }
  void append_to(std::vector<int64_t>& echoes) const {
    for (const auto& [power, echo] : best_) {
      if (power > 0.0) echoes.push_back(echo);
    }
  }

 private:
  void insert(double power, int64_t echo) {
    size_t i = kCount - 1;
    for (; i > 0 && best_[i - 1].first < power; --i) best_[i] = best_[i - 1];
    best_[i] = {power, echo};
  }
  std::array<std::pair<double, int64_t>, kCount> best_{};
};

// Holds carriers of some echoes in the order of their rows, each row filled up to whole lanes, and sums of them.
class TonesOfRows {
 public:
  explicit TonesOfRows(size_t num_rows);
  // Adds the carriers at samples that are evenly spaced. `first_sample` and `step` are in samples.
  void add(const Carriers& carriers, double first_sample, double step);
  // Adds the sums to rows.
  void give(std::vector<SampleRow>& rows) const;

 private:
  static constexpr int kMaxLanes = 8;  // at most so many carriers are computed side by side
  static constexpr size_t kSums = 2 * SampleRow::kSamples * kMaxLanes;
  void sort(const Carriers& carriers);

  std::vector<double> frequency_, re_, im_;
  std::vector<int> first_, count_;  // [row]
  std::vector<double> sums_;        // [row, kSums]
};

}  // namespace echopath
