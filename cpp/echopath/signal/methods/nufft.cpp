// Type-1 NUFFT of one row: each tone is spread with a narrow kernel onto a grid of twice the bandwidth, one FFT turns
// the grid into samples, and the kernel's own spectrum is divided out. A row is the grid, its ends overhanging by the
// kernel.
#include <algorithm>
#include <utility>
#include <vector>

#include "echopath/base/lanes/interleave.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/base/memory/recent_results.h"
#include "echopath/fft/fft.h"
#include "echopath/signal/kernels/nufft_kernel.h"
#include "echopath/signal/methods/method.h"

namespace echopath {
namespace {

constexpr int kOversampling = 2;

// The error of a tone grows steeply toward the ends of the samples; few samples cannot average it and get a wider grid.
constexpr int kFewSamples = 100, kMargin = 4;

// Returns a size that holds twice the samples, and twice the width so that the kernel does not meet itself.
int grid_size_for(int num_samples, int width) {
  const int margin = num_samples < kFewSamples ? kMargin : 0;
  return fast_fft_size(std::max(kOversampling * num_samples + margin, 2 * width));
}

int64_t row_length_for(int grid_size, int width) {
  return (int64_t{grid_size} + width + NufftKernel::padded(width) + 7) / 8 * 8;
}

// `values` and `out` are complex.
ECHOPATH_INLINE void scale(const double* values, const double* factor, int64_t count, double* __restrict out) {
  for (int64_t i = 0; i < count; ++i) {
    out[2 * i] = values[2 * i] * factor[i];
    out[2 * i + 1] = values[2 * i + 1] * factor[i];
  }
}

// Returns a buffer of this thread, which is made anew when the thread asks for another size.
FftBuffer& scratch(int size) {
  thread_local FftBuffer buffer(size);
  if (buffer.size() != size) buffer = FftBuffer(size);
  return buffer;
}

class Nufft : public SpreadMethod {
 public:
  Nufft(int num_samples, int width)
      : SpreadMethod(row_length_for(grid_size_for(num_samples, width), width), num_samples / 2), kernel_(width),
        grid_size_(grid_size_for(num_samples, width)), fft_(grid_size_, FftDirection::kBackward), correction_(num_samples) {
    const std::vector<double> spectrum = kernel_.transform(1.0 / grid_size_, reference_sample() + 1);  // even in the bin
    for (int bin = 0; bin <= reference_sample(); ++bin) {
      const double correction = 1.0 / spectrum[bin];
      correction_[reference_sample() - bin] = correction;
      if (reference_sample() + bin < num_samples) correction_[reference_sample() + bin] = correction;
    }
  }

  void add(const Carriers& carriers, Rows rows) const override { signal_kernels().spread(spreading(), carriers, rows); }

  SpreadGrid grid() const override { return {grid_size_, 1 - kernel_.width, correction_}; }

  Spreading spreading() const override {
    return {kernel_.width, kernel_.coefficients.data(), static_cast<double>(grid_size_), row_length()};
  }

  void samples(const double* row, std::complex<double>* out) const override {
    FftBuffer& grid = scratch(grid_size_);
    // Row cell i is grid cell i + 1 - width, modulo the grid, which is at least twice as long as the kernel is wide, but may
    // be shorter than what pads the row behind it.
    const int64_t before = kernel_.width - 1, end = before + grid_size_;
    const double* imaginary = row + row_length();
    run_simd<interleave>(row + before, imaginary + before, grid_size_, reinterpret_cast<double*>(grid.data()));
    for (int64_t i = 0; i < before; ++i) grid[grid_size_ - before + i] += std::complex<double>(row[i], imaginary[i]);
    for (int64_t i = end; i < row_length(); ++i) grid[(i - end) % grid_size_] += std::complex<double>(row[i], imaginary[i]);
    fft_.transform(grid);
    // Sample n is bin n - reference_sample(), modulo the grid.
    const int64_t num_below = reference_sample(), num_samples = std::ssize(correction_);
    const auto* bins = reinterpret_cast<const double*>(grid.data());
    auto* samples = reinterpret_cast<double*>(out);
    run_simd<scale>(bins + 2 * (grid_size_ - num_below), correction_.data(), num_below, samples);
    run_simd<scale>(bins, correction_.data() + num_below, num_samples - num_below, samples + 2 * num_below);
  }

 private:
  NufftKernel kernel_;
  int grid_size_;
  Fft fft_;
  std::vector<double> correction_;
};

constexpr size_t kKeptNuffts = 8;

}  // namespace

std::shared_ptr<const SpreadMethod> make_nufft(int num_samples, double tolerance) {
  using Recent = RecentResults<std::pair<int, int>, std::shared_ptr<const Nufft>>;
  static Recent& recent = *new Recent(kKeptNuffts);  // never destroyed: threads may outlive what is static
  const int width = NufftKernel::width_for(tolerance);
  return recent.get({num_samples, width}, [&] { return std::make_shared<const Nufft>(num_samples, width); });
}

}  // namespace echopath
