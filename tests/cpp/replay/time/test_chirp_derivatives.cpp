// Derivatives in each chirp are those of the polynomials, to the same bits wherever an echo stands.
#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/scenes.h"
#include "echopath/replay/time/chirp_derivatives.h"

namespace echopath::test_chirp_derivatives {
namespace {

using namespace testing;

constexpr double kRounding = 1e-9;  // of derivatives that are made of differences of ten values, relative
constexpr int kOrder = 10;

Radar radar_of_chirps(int num_chirps) {
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.waveform.num_chirps = num_chirps;
  return radar;
}

double delay_at(double time) { return 1e-7 * (1.0 + std::sin(40.0 * time)); }
double rate_at(double time) { return 1e-7 * 40.0 * std::cos(40.0 * time); }

// Derivatives of `count` echoes that all have delay_at.
Echoes derivatives(const Radar& radar, size_t count) {
  const FrameNodes nodes = chebyshev_nodes(radar, 0.0, {}, kOrder);
  std::vector<double> delay;
  for (const double time : nodes.times) delay.insert(delay.end(), count, delay_at(time));
  Echoes echoes;
  echoes.num_echoes = static_cast<int64_t>(count);
  echoes.sampling = derivative_sampling(radar.waveform.num_chirps, ChirpDerivatives::kThird);
  echoes.delay.resize(static_cast<size_t>(echoes.sampling.num_rows) * count);
  fill_derivatives(nodes.sampling.front(), delay.data(), echoes);
  return echoes;
}

TEST(ChirpDerivatives, AreThoseOfTheDelays) {
  const Radar radar = radar_of_chirps(16);
  for (const size_t count : {size_t{1}, size_t{11}}) {
    const Echoes echoes = derivatives(radar, count);
    for (int chirp = 0; chirp < 16; ++chirp) {
      const double rate = echoes.delay[(4 * static_cast<size_t>(chirp) + 1) * count + count - 1];
      EXPECT_NEAR(rate, rate_at(radar.chirp_time(0, chirp)), kRounding * 4e-6) << count << " echoes, chirp " << chirp;
    }
  }
}

TEST(ChirpDerivatives, HaveTheSameBitsAtAnyPlaceAmongAnyNumberOfEchoes) {
  const Radar radar = radar_of_chirps(8);
  const Echoes alone = derivatives(radar, 1);
  for (size_t count = 2; count < 100; ++count) {
    const Echoes many = derivatives(radar, count);
    for (size_t i = 0; i < many.delay.size(); ++i) {
      ASSERT_EQ(many.delay[i], alone.delay[i / count]) << "echo " << i % count << " of " << count << ", node " << i / count;
    }
  }
}

}  // namespace
}  // namespace echopath::test_chirp_derivatives
