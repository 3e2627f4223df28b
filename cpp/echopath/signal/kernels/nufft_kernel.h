#pragma once
// Approximates the spreading kernel of the NUFFT, the "exponential of semicircle" (Barnett, Magland, af Klinteberg 2019),
//   phi(u) = exp(beta (sqrt(1 - (2 u / width)^2) - 1)) for |u| <= width / 2 grid cells,
// by a polynomial in each of its unit pieces.
#include <vector>

namespace echopath {

struct NufftKernel {
  static constexpr int kMinWidth = 3;
  static constexpr int kMaxWidth = 16;
  // Returns the degree of the polynomials: a higher one would not make the tone error of width_for smaller.
  static constexpr int degree(int width) { return width <= 4 || width == 8 ? width : width - 1; }
  // Returns the values per coefficient row, which are whole vectors; the values beyond the width are zero.
  static constexpr int padded(int width) { return width <= 8 ? 8 : 16; }

  // Returns the width of the narrowest kernel on a grid of twice the samples whose rms error over the samples of any tone
  // stays below `tolerance` of its amplitude.
  static int width_for(double tolerance);

  explicit NufftKernel(int kernel_width);
  // Returns the Fourier transform at 0, step, 2 step ... cycles per grid cell: [count].
  std::vector<double> transform(double step, int count) const;

  int width;
  double beta;
  // [degree + 1, padded], highest power first: value i at t in [-1, 1] is phi(i - width / 2 + (t + 1) / 2).
  std::vector<double> coefficients;

 private:
  void set_nodes();
  std::vector<double> places_, weights_;  // of the quadrature in `transform`
};

}  // namespace echopath
