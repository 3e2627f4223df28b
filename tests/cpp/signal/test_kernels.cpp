#include <gtest/gtest.h>

#include <limits>

#include "cpp/signal/slow_sum.h"
#include "echopath/base/lanes/phasor.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/signal/echoes/echo_tiles.h"
#include "echopath/signal/kernels/kernels.h"
#include "echopath/signal/kernels/nufft_kernel.h"

namespace echopath::test_kernels {
namespace {

constexpr double kRounding = 1e-13;  // of sums of a thousand numbers in another order

template <PhasorError kError>
double worst_phasor_error() {
  double worst = 0.0;
  for (int i = -1000; i <= 1000; ++i) {
    const double x = i / 2000.0;
    const Phasor phasor = phasor_of_half_turns<kError>(x);
    const long double angle = std::numbers::pi_v<long double> * x;
    const double error = static_cast<double>(std::hypot(phasor.re - std::cos(angle), phasor.im - std::sin(angle)));
    worst = std::max(worst, error);
  }
  return worst;
}

// Against cosine and sine in extended precision.
TEST(Kernels, PhasorsAreAsExactAsTheirNames) {
  EXPECT_LT(worst_phasor_error<PhasorError::kRounding>(), 5e-16);
  EXPECT_LT(worst_phasor_error<PhasorError::k1em12>(), 1e-12);
  EXPECT_LT(worst_phasor_error<PhasorError::k7em6>(), 7e-6);
}

// Leaves not-a-numbers where the next call has its local arrays.
[[gnu::noinline]] void spoil_stack() {
  volatile double garbage[8192];
  for (volatile double& value : garbage) value = std::numeric_limits<double>::quiet_NaN();
}

// The picked instruction set, which the environment chooses, against the plainest one.
TEST(Kernels, RowsOfTilesEqualThoseOfTheBaseline) {
  ChirpSequence w = testing::reference_waveform();
  w.num_chirps = 4;
  const CarrierModel model(w, w.num_samples / 2);
  const Echoes echoes = testing::exact_echoes(w, testing::MovingPoints(1003, 3, 20.0, 24.0));
  EchoTiles tiles;
  tiles.assign(std::span(&echoes, 1), 1, w.sampling_rate / w.slope(), 1024);
  for (int width = NufftKernel::kMinWidth; width <= NufftKernel::kMaxWidth; ++width) {
    const NufftKernel kernel(width);
    const Spreading spreading{width, kernel.coefficients.data(), 1024.0, 1064};
    std::vector<double> rows[2];
    for (int i = 0; i < 2; ++i) {
      rows[i].resize(4 * 2 * 1064);
      for (const EchoTiles::Tile& tile : tiles.tiles()) {
        const TileAtChirps at{tiles.nodes(tile),
                              tile.count,
                              echoes.sampling.num_rows,
                              echoes.sampling.order,
                              4,
                              echoes.sampling.first_row.data(),
                              echoes.sampling.value.data(),
                              echoes.sampling.slope.data(),
                              false};
        TileRows to{rows[i].data(), 1064, 2 * 1064};
        const RowRoom room{[](void* of, const CellRange&) { return *static_cast<const TileRows*>(of); }, &to};
        spoil_stack();
        (i == 0 ? kernels_for<SignalKernels, InstructionSet::kBaseline>() : signal_kernels())
            .add_tile(model, spreading, at, room);
      }
    }
    double largest = 0.0;
    for (size_t i = 0; i < rows[0].size(); ++i) {
      largest = std::max(largest, std::abs(rows[0][i]));
      ASSERT_NEAR(rows[1][i], rows[0][i], kRounding * 1000) << width << " on " << name_of(instruction_set());
    }
    EXPECT_GT(largest, 0.1);
  }
}

}  // namespace
}  // namespace echopath::test_kernels
