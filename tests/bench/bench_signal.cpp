// The inner loops of synthesis by stage: ns per echo and chirp of one thread, in the first-level cache.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <random>
#include <vector>

#include "cpp/support/waveforms.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/radar/radar.h"
#include "echopath/signal/kernels/kernels.h"
#include "echopath/signal/kernels/nufft_kernel.h"
#include "echopath/signal/methods/method.h"

namespace {

using namespace echopath;

constexpr int kCount = TileAtChirps::kCapacity, kChirps = TileAtChirps::kMaxChirps, kLanes = TileAtChirps::kLanes;
constexpr double kGrid = 1024.0;
constexpr int64_t kRow = 1064;
constexpr double kLongest = 512e-9;  // s, of delay

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

template <class Work>
double nanoseconds(double echoes, Work work) {
  constexpr int kCalls = 200, kTrials = 30;
  double best = 1e300;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double begin = processor_seconds();
    for (int call = 0; call < kCalls; ++call) work();
    best = std::min(best, processor_seconds() - begin);
  }
  return 1e9 * best / (kCalls * echoes);
}

// A tile of echoes at rest over `cells` cells, sorted, or in any order.
struct Trial {
  std::vector<double> nodes, value, slope;
  std::vector<int> first_row = std::vector<int>(kChirps, 0);
  int num_nodes;

  Trial(int num_nodes_, double cells, bool is_sorted) : num_nodes(num_nodes_) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<double> delay(kCount);
    for (double& d : delay) d = 0.2 * kLongest + cells / kGrid * kLongest * unit(random);
    if (is_sorted) std::sort(delay.begin(), delay.end());
    nodes.resize(static_cast<size_t>(kCount) * num_nodes * 3);
    for (int p = 0; p < kCount; ++p) {
      for (int k = 0; k < num_nodes; ++k) {
        double* at = &nodes[(static_cast<size_t>(p / kLanes) * num_nodes + k) * 3 * kLanes + p % kLanes];
        at[0] = delay[p];
        at[kLanes] = unit(random);
        at[2 * kLanes] = unit(random);
      }
    }
    value.assign(static_cast<size_t>(kChirps) * num_nodes, 1.0 / num_nodes);
    slope.assign(value.size(), 0.0);
  }

  TileAtChirps at() const {
    return {nodes.data(), kCount, num_nodes, num_nodes, kChirps, first_row.data(), value.data(), slope.data()};
  }
};

}  // namespace

int main() {
  ChirpSequence waveform = testing::reference_waveform();
  waveform.chirp_interval = 60e-6;
  const CarrierModel model(waveform, waveform.num_samples / 2);
  std::vector<double> rows(2 * kRow * kChirps);
  std::printf("%s: states, phases and spreading of a tile, ns per echo and chirp\n", name_of(instruction_set()));
  std::printf("nodes  cells  width:");
  for (int width = 4; width <= 14; ++width) std::printf("%7d", width);
  for (const int num_nodes : {4, 8}) {
    for (const auto& [cells, is_sorted] :
         {std::pair{1.0, true}, {16.0, true}, {64.0, true}, {16.0, false}, {1000.0, true}}) {
      const Trial trial(num_nodes, cells, is_sorted);
      std::printf("\n%5d %6g %6s", num_nodes, cells, is_sorted ? "sorted" : "mixed");
      for (int width = 4; width <= 14; ++width) {
        const NufftKernel kernel(width);
        const Spreading spreading{width, kernel.coefficients.data(), kGrid, kRow};
        std::printf("%7.2f", nanoseconds(kCount * kChirps, [&] {
          signal_kernels().add_tile(model, spreading, trial.at(), rows.data(), 2 * kRow);
        }));
      }
    }
  }
  EchoStates states = {};
  for (int p = 0; p < kCount; ++p) states.delay[p] = kLongest * p / kCount;
  Carriers carriers;
  const double phases = nanoseconds(kCount, [&] { signal_kernels().modulate(model, states, kCount, carriers); });
  std::printf("\nphases alone, of states: %.2f\n", phases);
  const auto nufft = make_nufft(waveform.num_samples, 1e-6);
  const std::vector<double> row(2 * nufft->row_length());
  std::vector<std::complex<double>> samples(waveform.num_samples);
  std::printf("FFT of a row: %.0f ns\n", nanoseconds(1.0, [&] { nufft->samples(row.data(), samples.data()); }));
}
