// Type-1 NUFFT of one row: each tone is spread with a narrow kernel onto a grid of twice the bandwidth, one FFT turns
// the grid into samples, and the kernel's own spectrum is divided out. A row is the grid, its ends overhanging by the
// kernel.
#include <algorithm>
#include <vector>

#include "echopath/fft/fft.h"
#include "echopath/signal/method.h"
#include "echopath/signal/nufft_kernel.h"
#include "echopath/signal/phasor.h"

namespace echopath {
namespace {

constexpr int kOversampling = 2;

// Everything the spreading loop needs, by value.
struct Spreading {
  const double* coefficients;  // NufftKernel::coefficients
  double grid_size;            // M
  int64_t row_length;
};

struct Places {
  alignas(64) int32_t first[Carriers::kCapacity];  // grid cell of the first kernel value, counted from -width
  alignas(64) double t[Carriers::kCapacity];       // place in the cell, [-1, 1]
};

template <int kWidth>
ECHOPATH_INLINE void locate(const Carriers& carriers, double grid_size, Places& places) {
  for (int p = 0; p < carriers.count; ++p) {
    const double left = carriers.frequency[p] * grid_size + 0.5 * kWidth;
    const int32_t first = static_cast<int32_t>(left) + 1;
    places.first[p] = first;
    places.t[p] = 2.0 * (first - left) - 1.0;
  }
}

template <int kWidth>
ECHOPATH_INLINE void spread(const Spreading& spreading, const Carriers& carriers, Rows rows) {
  constexpr int kPadded = NufftKernel::padded(kWidth), kDegree = NufftKernel::degree(kWidth);
  Places places;
  locate<kWidth>(carriers, spreading.grid_size, places);
  for (int p = 0; p < carriers.count; ++p) {
    const double t = places.t[p], re = carriers.re[p], im = carriers.im[p];
    const double* coefficient = spreading.coefficients;
    alignas(64) double value[kPadded];
    ECHOPATH_NO_UNROLL
    for (int i = 0; i < kPadded; ++i) {
      double sum = coefficient[i];
      for (int d = 1; d <= kDegree; ++d) sum = sum * t + coefficient[d * kPadded + i];
      value[i] = sum;
    }
    double* out_re = rows.first + carriers.group[p] * rows.stride + places.first[p];
    double* out_im = out_re + spreading.row_length;
    ECHOPATH_NO_UNROLL
    for (int i = 0; i < kPadded; ++i) out_re[i] += re * value[i];
    ECHOPATH_NO_UNROLL
    for (int i = 0; i < kPadded; ++i) out_im[i] += im * value[i];
  }
}

ECHOPATH_SIMD void spread(int width, const Spreading& spreading, const Carriers& carriers, Rows rows) {
  switch (width) {
    case 3: return spread<3>(spreading, carriers, rows);
    case 4: return spread<4>(spreading, carriers, rows);
    case 5: return spread<5>(spreading, carriers, rows);
    case 6: return spread<6>(spreading, carriers, rows);
    case 7: return spread<7>(spreading, carriers, rows);
    case 8: return spread<8>(spreading, carriers, rows);
    case 9: return spread<9>(spreading, carriers, rows);
    case 10: return spread<10>(spreading, carriers, rows);
    case 11: return spread<11>(spreading, carriers, rows);
    case 12: return spread<12>(spreading, carriers, rows);
    case 13: return spread<13>(spreading, carriers, rows);
    case 14: return spread<14>(spreading, carriers, rows);
    case 15: return spread<15>(spreading, carriers, rows);
    default: return spread<16>(spreading, carriers, rows);
  }
}

// The grid must hold twice the samples, and the kernel without meeting itself.
int grid_size_for(int num_samples, int width) {
  return fast_fft_size(std::max(kOversampling * num_samples, 2 * width));
}

int64_t row_length_for(int grid_size, int width) {
  return (int64_t{grid_size} + width + NufftKernel::padded(width) + 7) / 8 * 8;
}

class Nufft : public ToneMethod {
 public:
  Nufft(int num_samples, int width)
      : ToneMethod(row_length_for(grid_size_for(num_samples, width), width), num_samples / 2),
        kernel_(width),
        grid_size_(grid_size_for(num_samples, width)),
        fft_(grid_size_, FftDirection::kBackward),
        correction_(num_samples) {
    for (int n = 0; n < num_samples; ++n) {
      correction_[n] = 1.0 / kernel_.transform(static_cast<double>(n - reference_sample()) / grid_size_);
    }
  }

  void add(const Carriers& carriers, Rows rows) const override {
    const Spreading spreading{kernel_.coefficients.data(), static_cast<double>(grid_size_), row_length()};
    spread(kernel_.width, spreading, carriers, rows);
  }

  void samples(const double* row, std::complex<double>* out) const override {
    FftBuffer grid(grid_size_);
    // Row cell i is grid cell i - width, modulo the grid.
    int64_t cell = (grid_size_ - kernel_.width) % grid_size_;
    for (int64_t i = 0; i < row_length(); ++i) {
      grid[cell] += std::complex<double>(row[i], row[i + row_length()]);
      if (++cell == grid_size_) cell = 0;
    }
    fft_.transform(grid);
    const int num_samples = static_cast<int>(correction_.size());
    for (int n = 0; n < num_samples; ++n) {
      const int bin = n - reference_sample();
      out[n] = grid[bin < 0 ? bin + grid_size_ : bin] * correction_[n];
    }
  }

 private:
  NufftKernel kernel_;
  int grid_size_;
  Fft fft_;
  std::vector<double> correction_;
};

}  // namespace

std::unique_ptr<const ToneMethod> make_nufft(int num_samples, double tolerance) {
  return std::make_unique<Nufft>(num_samples, NufftKernel::width_for(tolerance));
}

}  // namespace echopath
