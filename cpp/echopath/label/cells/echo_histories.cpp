#include "echopath/label/cells/echo_histories.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "echopath/base/threads/parallel.h"
#include "echopath/label/cells/middle_phase.h"
#include "echopath/replay/replay.h"

namespace echopath {
namespace {

constexpr size_t kStatesTogether = 1 << 20;  // of paths at times: 24 MiB
constexpr int64_t kRowsTogether = 64;

// Holds some paths at some times, [T, N] each.
struct States {
  States(const Replayer& replayer, std::span<const int64_t> some, std::span<const double> times, Job* job)
      : num_paths(some.size()), length(times.size() * some.size()), amplitude(length.size()) {
    replayer.evaluate(some, Replayer::Moment::in_rows(times, num_paths, length.data(), amplitude.data()), job);
  }

  size_t num_paths;
  std::vector<double> length;                   // m
  std::vector<std::complex<double>> amplitude;  // sqrt(W)
};

// Writes path `from` of the states as a row; `middle`: m, its length in the middle.
void write_row(const States& states, size_t from, double middle, const MiddlePhase& phase, size_t row, EchoHistories& out) {
  const size_t num_times = states.length.size() / states.num_paths;
  double largest = 0.0;
  for (size_t t = 0; t < num_times; ++t) {
    largest = std::max(largest, std::abs(states.amplitude[t * states.num_paths + from]));
  }
  out.largest[row] = largest;
  const double scale = 1.0 / std::max(largest, std::numeric_limits<double>::min());
  for (size_t t = 0; t < num_times; ++t) {
    const size_t state = t * states.num_paths + from, place = row * num_times + t;
    const double length = states.length[state];
    out.field[place] = std::complex<float>(scale * std::conj(states.amplitude[state]) * phase.of(length));
    out.farther[place] = static_cast<float>(length - middle);
  }
}

// Returns where weights begin and end that are not 0.
std::array<size_t, 2> extent(std::span<const std::complex<float>> weights) {
  const auto is_some = [](std::complex<float> weight) { return weight != 0.0f; };
  const auto first = std::ranges::find_if(weights, is_some);
  const auto last = std::find_if(weights.rbegin(), std::make_reverse_iterator(first), is_some);
  return {static_cast<size_t>(first - weights.begin()), static_cast<size_t>(last.base() - weights.begin())};
}

// Adds up in several sums side by side, which compilers keep in one vector.
std::complex<float> sum_of_products(const std::complex<float>* row, const std::complex<float>* weights, size_t count) {
  constexpr size_t kSums = 8;
  std::array<float, kSums> re{}, im{};
  const auto add = [&](size_t lane, std::complex<float> a, std::complex<float> b) {
    re[lane] += a.real() * b.real() - a.imag() * b.imag();
    im[lane] += a.real() * b.imag() + a.imag() * b.real();
  };
  size_t i = 0;
  for (; i + kSums <= count; i += kSums) {
    for (size_t lane = 0; lane < kSums; ++lane) add(lane, row[i + lane], weights[i + lane]);
  }
  for (; i < count; ++i) add(i % kSums, row[i], weights[i]);
  std::complex<float> sum = 0.0f;
  for (size_t lane = 0; lane < kSums; ++lane) sum += std::complex<float>(re[lane], im[lane]);
  return sum;
}

}  // namespace

EchoHistories echo_histories(const Paths& paths, std::span<const int64_t> some, std::span<const double> times, double middle,
                             Job* job) {
  const size_t num_times = times.size();
  EchoHistories found;
  found.field.resize(some.size() * num_times);
  found.farther.resize(some.size() * num_times);
  found.largest.resize(some.size());
  if (some.empty() || num_times == 0) return found;
  const Radar radar = one_channel(paths.radar);
  const Replayer replayer(paths, radar);
  const MiddlePhase phase(radar.waveform);
  const size_t together = std::max<size_t>(kStatesTogether / num_times, 1);
  for (size_t begin = 0; begin < some.size(); begin += together) {
    const std::span<const int64_t> block = some.subspan(begin, std::min(together, some.size() - begin));
    const std::array<double, 1> in_middle{middle};
    const States states(replayer, block, times, job), mean(replayer, block, in_middle, job);
    parallel_for_chunks(std::ssize(block), kRowsTogether, [&](int64_t first, int64_t last) {
      for (auto i = static_cast<size_t>(first); i < static_cast<size_t>(last); ++i) {
        write_row(states, i, mean.length[i], phase, begin + i, found);
      }
    });
  }
  return found;
}

std::vector<std::complex<float>> weighted_row_sums(std::span<const std::complex<float>> table, std::span<const int32_t> rows,
                                                   std::span<const std::complex<float>> weights, size_t num_times) {
  const size_t num_sums = num_times == 0 ? 0 : weights.size() / num_times;
  std::vector<std::array<size_t, 2>> extents;
  for (size_t i = 0; i < num_sums; ++i) extents.push_back(extent(weights.subspan(i * num_times, num_times)));
  std::vector<std::complex<float>> sums(num_sums * rows.size());
  parallel_for_chunks(std::ssize(rows), kRowsTogether, [&](int64_t first, int64_t last) {
    for (int64_t k = first; k < last; ++k) {
      const std::complex<float>* row = table.data() + static_cast<size_t>(rows[k]) * num_times;
      for (size_t i = 0; i < num_sums; ++i) {
        const auto [begin, end] = extents[i];
        sums[i * rows.size() + k] = sum_of_products(row + begin, weights.data() + i * num_times + begin, end - begin);
      }
    }
  });
  return sums;
}

}  // namespace echopath
