#include "echopath/base/lanes/phasor.h"
#include "echopath/signal/methods/method.h"

namespace echopath {
namespace {

// Adding and subtracting this leaves multiples of 2^-29, whose products with a sample's number are exact up to 2^24 samples.
constexpr double kSplit = 12582912.0;  // 1.5 * 2^23

ECHOPATH_INLINE void add_tone(double frequency, double re, double im, int num_samples, double* out_re, double* out_im) {
  const double high = (frequency + kSplit) - kSplit, low = frequency - high;
  for (int n = 0; n < num_samples; ++n) {
    const double turns = high * n;
    const Phasor phasor = phasor_of_cycles((turns - round_to_integer(turns)) + low * n);
    out_re[n] += re * phasor.re - im * phasor.im;
    out_im[n] += re * phasor.im + im * phasor.re;
  }
}

class Direct : public ToneMethod {
 public:
  explicit Direct(int num_samples) : ToneMethod(num_samples, 0), num_samples_(num_samples) {}

  void add(const Carriers& carriers, Rows rows) const override {
    for (int p = 0; p < carriers.count; ++p) {
      double* row = rows.of_group[carriers.group[p]] + rows.first;
      run_simd<add_tone>(carriers.frequency[p], carriers.re[p], carriers.im[p], num_samples_, row, row + row_length());
    }
  }

  void samples(const double* row, std::complex<double>* out) const override {
    for (int n = 0; n < num_samples_; ++n) out[n] = {row[n], row[n + row_length()]};
  }

 private:
  int num_samples_;
};

}  // namespace

std::unique_ptr<const ToneMethod> make_direct(int num_samples) { return std::make_unique<Direct>(num_samples); }

}  // namespace echopath
