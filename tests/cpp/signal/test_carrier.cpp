#include <gtest/gtest.h>

#include "cpp/signal/slow_sum.h"
#include "echopath/signal/kernels/carrier.h"

namespace echopath::test_carrier {
namespace {

// Of a phase of 1e5 turns: the roundings of its fraction alone.
constexpr double kStartPhase = 7e-14;  // rad

// At the sample nearest to the middle of the window, in extended precision.
TEST(Carrier, StartPhaseIsThatOfExtendedPrecision) {
  using Real = long double;
  for (const double bandwidth : {1e9, 0.77e9, 2.3e9}) {  // longer delays would ask more of the reference itself
    ChirpSequence w = testing::reference_waveform();
    w.num_chirps = 1;
    w.bandwidth = bandwidth;
    const CarrierModel model(w, w.num_samples / 2);
    std::vector<double> delay;
    for (int p = 0; p < 256; ++p) delay.push_back(2.0 * w.max_range() / 299792458.0 * (p + 0.618) / 257.0);
    const Echoes echoes = testing::static_echoes(1, delay, std::vector<testing::Complex>(256, 1.0));
    Carriers carriers;
    evaluate_carriers(model, echoes, 0, 0, 256, carriers);
    const Real mu = Real{w.bandwidth} * w.sampling_rate / w.num_samples, middle = Real(w.num_samples / 2) / w.sampling_rate;
    for (int p = 0; p < 256; ++p) {
      const Real tau = delay[p];
      const Real cycles = w.start_frequency * tau + mu * tau * middle - mu * tau * tau / 2;
      const Real angle = 2 * std::numbers::pi_v<Real> * (cycles - std::round(cycles));
      EXPECT_NEAR(carriers.re[p], static_cast<double>(std::cos(angle)), kStartPhase);
      EXPECT_NEAR(carriers.im[p], static_cast<double>(std::sin(angle)), kStartPhase);
    }
  }
}

}  // namespace
}  // namespace echopath::test_carrier
