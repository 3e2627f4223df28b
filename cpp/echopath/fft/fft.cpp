#include "echopath/fft/fft.h"

#include <fftw3.h>

#include <mutex>
#include <new>
#include <utility>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

// FFTW's planner and plan destruction share global state; execution does not.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

fftw_complex* as_fftw(std::complex<double>* data) { return reinterpret_cast<fftw_complex*>(data); }

bool is_fast(int size) {
  for (const int factor : {2, 3, 5}) {
    while (size % factor == 0) size /= factor;
  }
  return size == 1;
}

}  // namespace

FftBuffer::FftBuffer(int64_t size) : size_(size) {
  require(size >= 1, "size", "must be at least 1", size);
  data_ = reinterpret_cast<std::complex<double>*>(fftw_malloc(sizeof(fftw_complex) * static_cast<size_t>(size)));
  if (!data_) throw std::bad_alloc();
  std::uninitialized_fill_n(data_, size, std::complex<double>{});
}

FftBuffer::~FftBuffer() { fftw_free(data_); }

FftBuffer::FftBuffer(FftBuffer&& other) noexcept
    : size_(std::exchange(other.size_, 0)), data_(std::exchange(other.data_, nullptr)) {}

FftBuffer& FftBuffer::operator=(FftBuffer&& other) noexcept {
  std::swap(size_, other.size_);
  std::swap(data_, other.data_);
  return *this;
}

struct Fft::Plan {
  int size;
  fftw_plan plan = nullptr;

  Plan(int n, FftDirection direction) : size(n) {
    FftBuffer scratch(n);
    const std::lock_guard lock(planner_mutex());
    plan = fftw_plan_dft_1d(n, as_fftw(scratch.data()), as_fftw(scratch.data()),
                            direction == FftDirection::kForward ? FFTW_FORWARD : FFTW_BACKWARD, FFTW_ESTIMATE);
    if (!plan) throw std::bad_alloc();
  }
  ~Plan() {
    const std::lock_guard lock(planner_mutex());
    fftw_destroy_plan(plan);
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
};

Fft::Fft(int size, FftDirection direction) {
  require(size >= 1, "size", "must be at least 1", size);
  plan_ = std::make_unique<Plan>(size, direction);
}
Fft::~Fft() = default;
Fft::Fft(Fft&&) noexcept = default;

int Fft::size() const { return plan_->size; }

void Fft::transform(FftBuffer& buffer) const {
  require(buffer.size() == plan_->size, "buffer", "must have the size of the plan", buffer.size());
  fftw_execute_dft(plan_->plan, as_fftw(buffer.data()), as_fftw(buffer.data()));
}

int fast_fft_size(int size) {
  require(size >= 1, "size", "must be at least 1", size);
  while (!is_fast(size)) ++size;
  return size;
}

}  // namespace echopath
