#include "echopath/spectrum/window.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/meant_name.h"
#include "echopath/base/text/nearest_names.h"

namespace echopath {
namespace {

constexpr double kUsualChebyshev = 80.0, kUsualTaylor = 35.0, kUsualKaiser = 60.0;  // dB

// The names are in the order of WindowKind.
const std::vector<std::string> kNames = {"rect",      "hann",   "hamming", "blackman", "blackman_harris",
                                         "chebyshev", "taylor", "kaiser"};

// Returns sum_k (-1)^k coefficients[k] cos(2 pi k (i + shift) / n).
std::vector<double> cosine_window(int n, double shift, const std::vector<double>& coefficients) {
  std::vector<double> samples(n);
  for (int i = 0; i < n; ++i) {
    for (size_t k = 0; k < coefficients.size(); ++k) {
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      samples[i] += sign * coefficients[k] * std::cos(kTwoPi * static_cast<double>(k) * (i + shift) / n);
    }
  }
  return samples;
}

double chebyshev_polynomial(int order, double x) {
  if (std::abs(x) <= 1.0) return std::cos(order * std::acos(x));
  const double magnitude = std::cosh(order * std::acosh(std::abs(x)));
  return x < 0.0 && order % 2 != 0 ? -magnitude : magnitude;
}

// Dolph 1946: the spectrum at bin k is T_{n-1}(x0 cos(pi k / n)); the samples are its inverse transform about the centre.
std::vector<double> chebyshev_window(int n, double sidelobe_db) {
  const double x0 = std::cosh(std::acosh(std::pow(10.0, sidelobe_db / 20.0)) / (n - 1));
  std::vector<double> spectrum((n - 1) / 2 + 1), samples(n), cosine(2 * n);
  for (size_t k = 0; k < spectrum.size(); ++k) {
    spectrum[k] = chebyshev_polynomial(n - 1, x0 * std::cos(kPi * static_cast<double>(k) / n));
  }
  for (int i = 0; i < 2 * n; ++i) cosine[i] = std::cos(kPi * i / n);
  // For even n the spectrum is zero at k = n / 2 and odd about it, so bins below n / 2 are enough.
  for (int i = 0; i < n; ++i) {
    double sum = spectrum[0];
    for (size_t k = 1; k < spectrum.size(); ++k) {
      const int64_t turns = (int64_t{2} * i - (n - 1)) * static_cast<int64_t>(k) % (2 * n);
      sum += 2.0 * spectrum[k] * cosine[turns < 0 ? turns + 2 * n : turns];
    }
    samples[i] = sum;
  }
  return samples;
}

// Taylor 1955: the spectrum has the nulls of an equal ripple, stretched a little, below the lobe `lobes`, and from there on
// those of a window without taper. There are so many equal lobes as let the samples fall toward the ends of the window, and
// no more than their cosines can be told apart.
std::vector<double> taylor_window(int n, double sidelobe_db) {
  const double a = std::acosh(std::pow(10.0, sidelobe_db / 20.0)) / kPi;
  const int lobes = std::min(static_cast<int>(std::ceil(2.0 * a * a + 0.5)), n / 2 + 1);
  const double factor = lobes * lobes / (a * a + (lobes - 0.5) * (lobes - 0.5));
  std::vector<double> coefficients = {1.0};
  for (int m = 1; m < lobes; ++m) {
    double coefficient = m % 2 == 0 ? -1.0 : 1.0;
    for (int k = 1; k < lobes; ++k) {
      coefficient *= 1.0 - m * m / (factor * (a * a + (k - 0.5) * (k - 0.5)));
      if (k != m) coefficient /= 1.0 - static_cast<double>(m * m) / (k * k);
    }
    coefficients.push_back(coefficient);
  }
  return cosine_window(n, 0.5, coefficients);
}

// Kaiser and Schafer, "On the use of the I0-sinh window for spectrum analysis", 1980: the samples are
// I0(beta sqrt(1 - x^2)), and their fit of beta to the level of the first sidelobe is good to half a dB from 20 to 120 dB.
std::vector<double> kaiser_window(int n, double sidelobe_db) {
  const double above_rect = sidelobe_db - 13.26;
  const double beta =
      sidelobe_db < 60.0 ? 0.76609 * std::pow(above_rect, 0.4) + 0.09834 * above_rect : 0.12438 * (sidelobe_db + 6.3);
  std::vector<double> samples(n);
  for (int i = 0; i < n; ++i) {
    const double x = 2.0 * i / (n - 1) - 1.0;
    samples[i] = std::cyl_bessel_i(0.0, beta * std::sqrt(1.0 - x * x));
  }
  return samples;
}

std::vector<double> scaled_to_one(std::vector<double> samples) {
  const double largest = *std::ranges::max_element(samples);
  for (double& sample : samples) sample /= largest;
  return samples;
}

// `shift` is that of cosine windows, in steps: 0 makes them periodic, 1/2 symmetric.
std::vector<double> samples_of(const Window& window, int n, double shift) {
  require(n >= 1, "n", "must be at least 1", n);
  if (n == 1) return {1.0};
  switch (window.kind) {
    case WindowKind::kRect: return std::vector<double>(n, 1.0);
    case WindowKind::kHann: return cosine_window(n, shift, {0.5, 0.5});
    case WindowKind::kHamming: return cosine_window(n, shift, {0.54, 0.46});
    case WindowKind::kBlackman: return cosine_window(n, shift, {0.42, 0.5, 0.08});
    case WindowKind::kBlackmanHarris: return cosine_window(n, shift, {0.35875, 0.48829, 0.14128, 0.01168});
    case WindowKind::kChebyshev:
    case WindowKind::kTaylor:
    case WindowKind::kKaiser: break;
  }
  const double level = window.level();
  require(level >= 20.0 && level <= 300.0, "sidelobe_db", "must be in [20, 300]", level);
  if (window.kind == WindowKind::kKaiser) return scaled_to_one(kaiser_window(n, level));
  return scaled_to_one(window.kind == WindowKind::kTaylor ? taylor_window(n, level) : chebyshev_window(n, level));
}

double sum_of(const std::vector<double>& samples) { return std::accumulate(samples.begin(), samples.end(), 0.0); }

}  // namespace

Window Window::named(const std::string& name, std::optional<double> sidelobe_db) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) {
    const std::string meant = meant_name(name, kNames);
    throw std::invalid_argument(
        "window: must be rect, hann, hamming, blackman, blackman_harris, chebyshev, taylor or kaiser, got '" + name +
        "'; nearest: " + (meant.empty() ? nearest_names(name, kNames, 1).front() : meant));
  }
  return {static_cast<WindowKind>(found - kNames.begin()), sidelobe_db};
}

double Window::level() const {
  if (kind == WindowKind::kKaiser) return sidelobe_db.value_or(kUsualKaiser);
  return sidelobe_db.value_or(kind == WindowKind::kTaylor ? kUsualTaylor : kUsualChebyshev);
}

std::string Window::name() const { return kNames.at(static_cast<size_t>(kind)); }

std::vector<double> window_samples(const Window& window, int n) { return samples_of(window, n, 0.0); }

std::vector<double> centred_window_samples(const Window& window, int n) { return samples_of(window, n, 0.5); }

std::vector<double> unit_taper(const Window& window, int n, double scale) {
  std::vector<double> samples = window_samples(window, n);
  const double unit = scale / sum_of(samples);
  for (double& sample : samples) sample *= unit;
  return samples;
}

double equivalent_noise_bandwidth(const std::vector<double>& samples) {
  const double power = std::inner_product(samples.begin(), samples.end(), samples.begin(), 0.0);
  return static_cast<double>(samples.size()) * power / (sum_of(samples) * sum_of(samples));
}

double main_lobe_half_width(const std::vector<double>& samples) {
  constexpr int kSteps = 64;  // per bin
  const int last = kSteps * static_cast<int>(samples.size()) / 2;
  const auto num_zeros = std::count(samples.begin(), samples.end(), 0.0);
  if (num_zeros + 1 == static_cast<std::ptrdiff_t>(samples.size())) return static_cast<double>(last) / kSteps;  // no null
  double before = 1.0;
  for (int step = 1; step <= last; ++step) {
    const double level = std::abs(tone_response(samples, static_cast<double>(step) / kSteps));
    if (level >= before) return static_cast<double>(step - 1) / kSteps;
    before = level;
  }
  return static_cast<double>(last) / kSteps;
}

std::complex<double> tone_response(const std::vector<double>& samples, double bins) {
  const double n = static_cast<double>(samples.size()), middle = 0.5 * (n - 1.0);
  std::complex<double> sum;
  for (size_t i = 0; i < samples.size(); ++i) {
    sum += std::polar(samples[i], -kTwoPi * bins * (static_cast<double>(i) - middle) / n);
  }
  return sum / sum_of(samples);
}

}  // namespace echopath
