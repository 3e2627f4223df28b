#include <gtest/gtest.h>

#include "cpp/signal/slow_sum.h"
#include "echopath/base/simd.h"
#include "echopath/signal/echo_tiles.h"
#include "echopath/signal/kernels.h"
#include "echopath/signal/nufft_kernel.h"

namespace echopath {
namespace kernels_baseline { extern const SignalKernels kKernels; }

namespace {

constexpr double kRounding = 1e-13;  // of sums of a thousand numbers in another order

// The picked instruction set, which the environment chooses, against the plainest one.
TEST(Kernels, RowsOfTilesEqualThoseOfTheBaseline) {
  ChirpSequence w = testing::reference_waveform();
  w.num_chirps = 4;
  const CarrierModel model(w, w.num_samples / 2);
  const Echoes echoes = testing::exact_echoes(w, testing::MovingPoints(1000, 3, 20.0, 24.0));
  EchoTiles tiles;
  tiles.assign(std::span(&echoes, 1), 1, w.sampling_rate / w.slope());
  for (int width = NufftKernel::kMinWidth; width <= NufftKernel::kMaxWidth; ++width) {
    const NufftKernel kernel(width);
    const Spreading spreading{width, kernel.coefficients.data(), 1024.0, 1064};
    std::vector<double> rows[2];
    for (int i = 0; i < 2; ++i) {
      rows[i].resize(4 * 2 * 1064);
      for (const EchoTiles::Tile& tile : tiles.tiles()) {
        const TileAtChirps at{tiles.nodes(tile), tile.count, echoes.sampling.num_nodes, echoes.sampling.order, 4,
                              echoes.sampling.first_node.data(), echoes.sampling.value.data(), echoes.sampling.slope.data()};
        (i == 0 ? kernels_baseline::kKernels : signal_kernels()).add_tile(model, spreading, at, rows[i].data(), 2 * 1064);
      }
    }
    double largest = 0.0, difference = 0.0;
    for (size_t i = 0; i < rows[0].size(); ++i) {
      largest = std::max(largest, std::abs(rows[0][i]));
      difference = std::max(difference, std::abs(rows[0][i] - rows[1][i]));
    }
    EXPECT_GT(largest, 0.1);
    EXPECT_LT(difference, kRounding * 1000) << width << " on " << name_of(instruction_set());
  }
}

}  // namespace
}  // namespace echopath
