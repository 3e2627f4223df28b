#pragma once
// Where a tone lies between the cells of a windowed transform.
#include <complex>
#include <vector>

namespace echopath {

class ToneOffset {
 public:
  // `samples` of the window, transform padded to zero_pad times their number.
  ToneOffset(const std::vector<double>& samples, int zero_pad);

  // Turns the field of the cell above (below: its conjugate) into phase with that of the cell.
  std::complex<double> phasor() const { return phasor_; }
  // Offset in cells from in-phase ratios of the neighbours above and below; within +-kLargest.
  double offset(double above, double below) const;
  // Power that a tone at this offset shows in the cell, relative to its own.
  double power(double offset) const;

 private:
  double difference(double offset) const;

  std::vector<double> samples_;
  double step_;                       // of a cell, in bins
  std::complex<double> phasor_;
  std::vector<double> difference_;    // of the ratios, at kNodes offsets
};

}  // namespace echopath
