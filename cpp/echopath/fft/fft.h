#pragma once
// Wraps FFTW's Fourier transforms in double precision; FFTW appears nowhere else.
#include <complex>
#include <cstdint>
#include <memory>

namespace echopath {

// Holds aligned complex numbers, zero at first, for a transform to work on.
class FftBuffer {
 public:
  explicit FftBuffer(int64_t size);  // raises invalid_argument unless size >= 1, bad_alloc when memory is short
  ~FftBuffer();
  FftBuffer(FftBuffer&& other) noexcept;
  FftBuffer& operator=(FftBuffer&& other) noexcept;
  int64_t size() const { return size_; }
  std::complex<double>* data() { return data_; }
  const std::complex<double>* data() const { return data_; }
  std::complex<double>& operator[](int64_t i) { return data_[i]; }
  const std::complex<double>& operator[](int64_t i) const { return data_[i]; }

 private:
  int64_t size_ = 0;
  std::complex<double>* data_ = nullptr;
};

// The transform is out[k] = sum_n in[n] e^{-+ j 2 pi k n / size}, forward with the minus; neither direction is normalised.
enum class FftDirection { kForward, kBackward };

// Holds a plan for one size. Planning is estimated, never measured, so that the same input gives the same bits in every run.
class Fft {
 public:
  Fft(int size, FftDirection direction);  // raises invalid_argument unless size >= 1
  ~Fft();
  Fft(Fft&&) noexcept;
  int size() const;
  // Transforms in place; raises invalid_argument unless the buffer has the plan's size. Safe from several threads on
  // different buffers.
  void transform(FftBuffer& buffer) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

// Returns the smallest 2^a 3^b 5^c >= size; such sizes transform quickly.
int fast_fft_size(int size);

}  // namespace echopath
