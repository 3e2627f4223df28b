#pragma once
// Computes tapering windows and their figures of merit (Harris, "On the use of windows for harmonic analysis with the
// discrete Fourier transform", 1978).
#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace echopath {

enum class WindowKind { kRect, kHann, kHamming, kBlackman, kBlackmanHarris, kChebyshev, kTaylor, kKaiser };

struct Window {
  WindowKind kind = WindowKind::kHann;
  // dB, positive, below the main lobe: of kChebyshev the level of all sidelobes, of kTaylor that of the nearest ones, of
  // kKaiser that of the first one, to a dB by 48 samples or more and to 3 dB by 16, up to 120 dB; beyond these they fall
  // with their number. Fewer samples than it has dB may miss Taylor's level by up to 5 dB, fewer than a third as many by
  // much more. Not given, it is 80 for kChebyshev, 35 for kTaylor and 60 for kKaiser.
  std::optional<double> sidelobe_db = {};

  // Takes "rect", "hann", "hamming", "blackman", "blackman_harris", "chebyshev", "taylor" or "kaiser"; raises
  // invalid_argument naming the nearest.
  static Window named(const std::string& name, std::optional<double> sidelobe_db = {});
  double level() const;  // dB, of windows that have one
  bool has_level() const { return kind >= WindowKind::kChebyshev; }
  std::string name() const;
  bool operator==(const Window& other) const { return kind == other.kind && (!has_level() || level() == other.level()); }
};

// Holds the windows along the two axes of a map. One window stands for both.
struct MapWindows {
  Window range, velocity;

  MapWindows() = default;
  MapWindows(const Window& both) : range(both), velocity(both) {}
  MapWindows(const Window& of_range, const Window& of_velocity) : range(of_range), velocity(of_velocity) {}
  bool operator==(const MapWindows&) const = default;
};

// Returns the samples [n], at most 1; {1} for n = 1. Cosine windows are periodic (w[i] = w[n - i] with period n: a DFT bin
// grid sees exact gains such as 0.5 and 1.5 for Hann); Dolph-Chebyshev, Taylor and Kaiser are symmetric
// (w[i] = w[n - 1 - i]), which their sidelobes require. Raises invalid_argument unless n >= 1 and 20 <= sidelobe_db <= 300.
std::vector<double> window_samples(const Window& window, int n);

// Returns samples for few points in space: cosine windows are sampled at i + 1/2 instead of i, hence symmetric and nowhere
// 0.
std::vector<double> centred_window_samples(const Window& window, int n);

// Returns window_samples divided by their sum, times `scale`.
std::vector<double> unit_taper(const Window& window, int n, double scale = 1.0);

double equivalent_noise_bandwidth(const std::vector<double>& samples);  // n sum w^2 / (sum w)^2, bins
double main_lobe_half_width(const std::vector<double>& samples);        // from a tone to its first null, bins, to 1/64
// Returns the response to a tone `bins` away, 1 at 0; it is real where samples are symmetric about their middle (n - 1) / 2.
std::complex<double> tone_response(const std::vector<double>& samples, double bins);

}  // namespace echopath
