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
  volatile double garbage[32768];
  for (volatile double& value : garbage) value = std::numeric_limits<double>::quiet_NaN();
}

constexpr int kChirps = TileAtChirps::kMaxChirps, kCells = 1024, kRowLength = 1064;

ChirpSequence chirps_of_a_tile() {
  ChirpSequence w = testing::reference_waveform();
  w.num_chirps = kChirps;
  return w;
}

Echoes moving_echoes() { return testing::exact_echoes(chirps_of_a_tile(), testing::MovingPoints(1003, 3, 20.0, 24.0)); }

// Straight motion between the first and the last of their rows, which all chirps take.
Echoes echoes_of_two_nodes() {
  const Echoes exact = moving_echoes();
  const auto count = static_cast<size_t>(exact.num_echoes), last = exact.delay.size() - count;
  Echoes echoes;
  echoes.num_echoes = exact.num_echoes;
  TimeSampling& sampling = echoes.sampling;
  sampling.num_rows = sampling.order = 2;
  sampling.first_row.assign(kChirps, 0);
  const double span = kChirps * chirps_of_a_tile().chirp_interval;
  for (int chirp = 0; chirp < kChirps; ++chirp) {
    const double x = (chirp + 0.5) / kChirps;
    sampling.value.insert(sampling.value.end(), {1.0 - x, x});
    sampling.slope.insert(sampling.slope.end(), {-1.0 / span, 1.0 / span});
  }
  for (const size_t first : {size_t{0}, last}) {
    echoes.delay.insert(echoes.delay.end(), &exact.delay[first], &exact.delay[first] + count);
    echoes.amplitude.insert(echoes.amplitude.end(), &exact.amplitude[first], &exact.amplitude[first] + count);
  }
  return echoes;
}

// Returns the rows of the first chirps, [chirp, re/im, cell].
std::vector<double> rows_of(const SignalKernels& kernels, const Echoes& echoes, int width, int num_chirps) {
  const ChirpSequence w = chirps_of_a_tile();
  const CarrierModel model(w, w.num_samples / 2);
  EchoTiles tiles;
  tiles.assign(std::span(&echoes, 1), 1, w.sampling_rate / w.slope(), kCells);
  const NufftKernel kernel(width);
  const Spreading spreading{width, kernel.coefficients.data(), kCells, kRowLength};
  std::vector<double> rows(static_cast<size_t>(num_chirps * 2 * kRowLength));
  for (const EchoTiles::Tile& tile : tiles.tiles()) {
    const TileAtChirps at{tiles.nodes(tile),
                          tile.count,
                          echoes.sampling.num_rows,
                          echoes.sampling.order,
                          num_chirps,
                          echoes.sampling.first_row.data(),
                          echoes.sampling.value.data(),
                          echoes.sampling.slope.data(),
                          false};
    TileRows to{rows.data(), kRowLength, 2 * kRowLength};
    const RowRoom room{[](void* of, const CellRange&) { return *static_cast<const TileRows*>(of); }, &to};
    spoil_stack();
    kernels.add_tile(model, spreading, at, room);
  }
  return rows;
}

// The picked instruction set, which the environment chooses, against the plainest one.
void expect_rows_of_the_baseline(const Echoes& echoes) {
  for (int width = NufftKernel::kMinWidth; width <= NufftKernel::kMaxWidth; ++width) {
    for (const int num_chirps : {1, 4, 5, kChirps}) {
      const auto rows = rows_of(signal_kernels(), echoes, width, num_chirps);
      const auto expected = rows_of(kernels_for<SignalKernels, InstructionSet::kBaseline>(), echoes, width, num_chirps);
      double largest = 0.0;
      for (size_t i = 0; i < rows.size(); ++i) {
        largest = std::max(largest, std::abs(expected[i]));
        ASSERT_NEAR(rows[i], expected[i], kRounding * 1000) << width << " on " << name_of(instruction_set());
      }
      EXPECT_GT(largest, 0.1);
    }
  }
}

TEST(Kernels, RowsOfTilesEqualThoseOfTheBaseline) { expect_rows_of_the_baseline(moving_echoes()); }
TEST(Kernels, RowsOfTilesOfTwoNodesEqualThoseOfTheBaseline) { expect_rows_of_the_baseline(echoes_of_two_nodes()); }

// One chirp alone goes another way than several together.
TEST(Kernels, ChirpsTogetherEqualChirpsOneByOne) {
  Echoes echoes = echoes_of_two_nodes();
  for (const int width : {4, 8, 12}) {
    const auto together = rows_of(signal_kernels(), echoes, width, kChirps);
    Echoes one = echoes;
    for (int chirp = 0; chirp < kChirps; ++chirp) {
      one.sampling.value.assign(&echoes.sampling.value[2 * chirp], &echoes.sampling.value[2 * chirp] + 2);
      one.sampling.slope.assign(&echoes.sampling.slope[2 * chirp], &echoes.sampling.slope[2 * chirp] + 2);
      const auto alone = rows_of(signal_kernels(), one, width, 1);
      for (size_t i = 0; i < alone.size(); ++i)
        ASSERT_NEAR(together[static_cast<size_t>(chirp) * alone.size() + i], alone[i], kRounding * 1000) << width;
    }
  }
}

}  // namespace
}  // namespace echopath::test_kernels
