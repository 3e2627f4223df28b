#pragma once
// Finds where a tone lies between the cells of a windowed transform.
#include <complex>
#include <vector>

namespace echopath {

class ToneOffset {
 public:
  // `samples` are those of the window; the transform is padded to zero_pad times their number.
  ToneOffset(const std::vector<double>& samples, int zero_pad);

  // Returns whether all cells have the same of a tone, as where one sample of the window counts: no cell tells where it is.
  bool is_flat() const;
  // The field of the cell above times this, or of the cell below times its conjugate, is in phase with that of the cell.
  std::complex<double> phasor() const { return phasor_; }
  // Returns the offset in cells, within +-kLargest, from the in-phase ratios of the neighbours above and below to the cell;
  // 0 where the response is flat.
  double offset(double above, double below) const;
  // Returns the power of a tone at this offset in the cell, relative to the tone's own.
  double power(double offset) const;

 private:
  double difference(double offset) const;

  std::vector<double> samples_;
  double step_;  // of a cell, in bins
  std::complex<double> phasor_;
  std::vector<double> difference_;  // of the two ratios, at kNodes offsets
};

}  // namespace echopath
