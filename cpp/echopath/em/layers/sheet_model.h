#pragma once
// Models what a sheet does to a wave that goes through it.
//
// A leg of a path stays straight: its wave is multiplied by the transmission of a plane wave of its direction, over that of
// free space between the same faces. The delay of the sheet, by which its phase grows over the band, is part of the length
// of the path: the mean, as bounces within a thick sheet let it swing. A refracted wave leaves the sheet beside the
// straight line by `offset`. The phase of the transmission has this to first order; what is left is k offset^2 / (2
// length), the detour of a wave that meets the far end of the leg all the same, and it is added where the offset exceeds a
// tenth of a wavelength.
#include <optional>

#include "echopath/base/frequency_band.h"
#include "echopath/base/geometry.h"
#include "echopath/em/layers/layer_stack.h"

namespace echopath {

// Holds what one crossing does to the wave, in both modes.
struct SheetPassage {
  std::complex<double> te, tm;            // over free space
  double te_delay = 0.0, tm_delay = 0.0;  // m, longer than free space, mean over the band
  double offset = 0.0;                    // m, across the ray, toward the foot of the normal at the point of entry
};

// Gives the sine of the angle of incidence below which both modes pass alike, so that no plane of incidence is needed.
inline constexpr double kMinSineOfModes = 1e-9;

class SheetModel {
 public:
  // `material` has layers; fields and offsets are told at `frequency` (Hz), delays over the band, or at its lowest frequency
  // where it has no width.
  SheetModel(const Material& material, double frequency, const FrequencyBand& band);
  // cos_incidence in [0, 1] is taken from the normal, of either side: both have the same passage.
  SheetPassage passage(double cos_incidence) const;
  // Returns the phase in rad that a wave turns by within the layers and back, straight through: about the rate at which a
  // passage changes with the cosine.
  double most_phase() const { return at_.most_phase(); }

 private:
  LayerStack at_, highest_;           // at the frequency, and at the upper end of the band
  std::optional<LayerStack> lowest_;  // at the lower end, where the frequency is another
  double turn_;                       // m of length per rad between both ends
};

// Returns the share of the TE mode in the power of a wave that travels along `direction` with a polarisation, which need not
// lie across it, and meets a surface with `normal` (unit vectors). It is 1 where the plane of incidence has no direction.
double te_share(const Vec3& polarization, const Vec3& direction, const Vec3& normal);

// Holds what a sheet does to a wave with a given share of the TE mode that is received in the polarisation that it has.
struct SheetFactor {
  std::complex<double> field;
  double delay;  // m
};
SheetFactor sheet_factor(const SheetPassage& passage, double te_share);

// Returns the length in m by which a leg of `length` (m) is longer than the straight line, through sheets that offset it by
// `offset` in all (m).
double detour(const Vec3& offset, double length, double wavelength);

}  // namespace echopath
