#pragma once
// Adds many complex tones in one of several ways behind one interface. A row holds the signal of one chirp, channel and
// group in the form that the method adds up quickest; `samples` turns it into time samples. All methods are linear: rows may
// be added.
#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

#include "echopath/signal/kernels/kernels.h"

namespace echopath {

class ToneMethod {
 public:
  virtual ~ToneMethod() = default;
  int64_t row_length() const { return row_length_; }          // doubles of the real part of a row
  int reference_sample() const { return reference_sample_; }  // where carriers have their phase
  // Adds the carriers in their order, each to the row of its group. Several threads may add to different rows.
  virtual void add(const Carriers& carriers, Rows rows) const = 0;
  // Writes the time samples [num_samples] of one row (2 * row_length() doubles) to `out`.
  virtual void samples(const double* row, std::complex<double>* out) const = 0;

 protected:
  ToneMethod(int64_t row_length, int reference_sample) : row_length_(row_length), reference_sample_(reference_sample) {}

 private:
  int64_t row_length_;
  int reference_sample_;
};

// The grid that rows are: sample n is correction_n sum_i g_i e^{j 2 pi i (n - reference_sample) / size} of the cells g_i of
// a row, the first of which is cell `first`.
struct SpreadGrid {
  int64_t size, first;
  const std::vector<double>& correction;  // [num_samples]
};

// Adds by spreading on a grid, for which there are quicker loops over echoes in tiles.
class SpreadMethod : public ToneMethod {
 public:
  using ToneMethod::ToneMethod;
  virtual SpreadGrid grid() const = 0;      // valid while the method lives
  virtual Spreading spreading() const = 0;  // valid while the method lives
};

// Makes the reference: sine and cosine of every sample. Its error is 1e-13 of the sum of |a|.
std::unique_ptr<const ToneMethod> make_direct(int num_samples);
// Makes powers of e^{j 2 pi f} by multiplication, in blocks. The error is 1e-13 of the sum of |a| at 512 samples, and grows
// with their number.
std::unique_ptr<const ToneMethod> make_recurrence(int num_samples);
// Makes a type-1 non-uniform FFT. Its rms error over the samples is below `tolerance` of the sum of |a|, for 1e-13 <=
// tolerance <= 0.1 (and not below the rounding of 1e-16 x num_samples); the largest error of one sample is up to six times
// that. Those of the last few sizes are kept, because making one takes as long as adding a thousand tones.
std::shared_ptr<const SpreadMethod> make_nufft(int num_samples, double tolerance);

}  // namespace echopath
