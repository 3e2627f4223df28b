#pragma once
// Interpolates measured or computed antenna patterns: gain and phase over azimuth and elevation.
#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/radar/gain_axis.h"

namespace echopath {

// Holds the gain and phase of an antenna toward a direction.
struct AntennaGain {
  double power = 1.0;  // linear
  double phase = 0.0;  // rad, of the field; enters path amplitudes as e^{j phase}, in transmission and reception
};

// Bounds the mean power gain over the sphere that an antenna may have: no antenna radiates more power than it is fed. The
// excess over 1 is noise of tables.
inline constexpr double kLargestEfficiency = 1.02;

// A field that falls as exp(-s^2 x^2 / 2) over the angle x has the sharpness s, in 1/rad. Its largest slope is the peak
// times s over this number.
inline constexpr double kSlopeOfSharpness = 1.6487212707001282;  // sqrt(e)

// Holds gain over direction in the antenna's frame: boresight is +x, azimuth turns about z (left, +y, positive), and
// elevation is taken from the xy-plane.
//
// Between the samples the field sqrt(gain) e^{j phase} is interpolated by bicubics with a continuous slope (cubic
// Hermite, slopes of parabolas through three samples), so that neither gain nor phase has kinks for moving targets
// and nulls stay nulls. Phases of neighbours should differ by less than 1 rad, or their power is lost between them. A
// cell whose four corners have no gain (below 1e-12 of the peak) has none, and there is none outside the table.
// Four azimuths or more that cover the whole turn, up to a gap of one step, are closed to a ring.
class GainTable {
 public:
  // azimuth [A] rad, ascending, over at most a turn; elevation [E] rad, ascending, in [-pi/2, pi/2]; A, E >= 2
  // gain [E, A] linear power gain, >= 0 and not all 0
  // phase [E, A] rad or empty: of the far field in the e^{+jwt} convention, relative to the antenna's position (an
  //   element that sits at d instead has +k d.u toward u)
  // kMeanOfOne: scales the gain to a mean of 1 over the sphere, that of an antenna without losses
  // Raises invalid_argument naming the argument, also when the mean gain over the sphere exceeds 1.02.
  enum class Scale { kAsGiven, kMeanOfOne };
  GainTable(std::vector<double> azimuth, std::vector<double> elevation, std::vector<double> gain,
            std::vector<double> phase = {}, Scale scale = Scale::kAsGiven);

  // These return what the constructor was given, the gain as it was scaled.
  const std::vector<double>& azimuth() const { return azimuth_; }
  const std::vector<double>& elevation() const { return elevation_; }
  const std::vector<double>& gain() const { return gain_; }
  const std::vector<double>& phase() const { return phase_; }

  // Returns sqrt(gain) e^{j phase} toward a unit direction in the antenna's frame.
  std::complex<double> field(const Vec3& direction) const;
  AntennaGain toward(const Vec3& direction) const;
  double peak_gain() const;  // of the samples
  // Returns a bound of |field| anywhere. It is the farther above the samples the less even these are: with q the largest
  // ratio of neighbouring steps, the weights along an axis add up to at most 4 + q by size.
  double largest_field() const { return largest_field_; }
  double sharpness() const { return sharpness_; }       // 1/rad, that its steepest step tells
  double efficiency() const { return efficiency_; }     // mean gain over the sphere: its integral / 4 pi
  bool is_dark_behind() const { return dark_behind_; }  // no gain where x < 0

 private:
  std::optional<size_t> find_column(double& azimuth) const;
  std::optional<size_t> find_row(double& elevation) const;
  std::complex<double> field_at(double azimuth, double elevation) const;
  void set_field();
  void close_ring();
  void lay_out();
  double integrate() const;
  double find_sharpness() const;
  double most_beyond_samples() const;  // the largest |field| anywhere over that of the samples, at most
  bool all_cells_in_front() const;

  std::vector<double> azimuth_, elevation_, gain_, phase_;
  std::vector<std::complex<double>> field_;  // [E, A]
  int period_ = 0;                           // columns of a closed ring, 0: open
  GainAxis columns_, rows_;
  std::vector<double> parts_[2];    // real and, where there are phases, imaginary part of the field, as laid out
  std::vector<uint8_t> lit_cells_;  // by row and column: whether the cell has gain
  double efficiency_ = 0.0, largest_field_ = 0.0, sharpness_ = 0.0;
  bool dark_behind_ = false;
};

}  // namespace echopath
