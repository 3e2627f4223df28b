#include "echopath/em/layers/sheet_model.h"

#include <algorithm>

#include "echopath/base/constants.h"
#include "echopath/em/polarization/hit_modes.h"

namespace echopath {
namespace {

constexpr double kLeastBand = 1e-6;    // of a frequency, over which the delay at this frequency alone is told
constexpr double kLeastOffset = 0.1;   // wavelengths
constexpr double kLeastField = 1e-12;  // of a polarisation's square: what lies along the direction has no mode

double width_of(const FrequencyBand& band) { return std::max(band.highest - band.lowest, kLeastBand * band.lowest); }

}  // namespace

SheetModel::SheetModel(const Material& material, double frequency, const FrequencyBand& band)
    : at_(material.layers, frequency), highest_(material.layers, band.lowest + width_of(band)),
      turn_(kSpeedOfLight / (kTwoPi * width_of(band))) {
  if (frequency != band.lowest) lowest_.emplace(material.layers, band.lowest);
}

SheetPassage SheetModel::passage(double cos_incidence) const {
  LayerPhases first, last;
  const LayerTransmission at = at_.over_free_space(cos_incidence, &first);
  if (lowest_) lowest_->over_free_space(cos_incidence, &first);
  highest_.over_free_space(cos_incidence, &last);
  return {at.te, at.tm, turn_ * (first.te - last.te), turn_ * (first.tm - last.tm), at_.offset(cos_incidence)};
}

double te_share(const Vec3& polarization, const Vec3& direction, const Vec3& normal) {
  const Vec3 across = direction.cross(normal), field = polarization - direction.dot(polarization) * direction;
  const double sine = across.squaredNorm(), size = field.squaredNorm();
  if (sine < kMinSine * kMinSine || size < kLeastField) return 1.0;
  const double along = across.dot(field);
  return std::min(1.0, along * along / (sine * size));
}

SheetFactor sheet_factor(const SheetPassage& passage, double te_share) {
  const double te = te_share * std::norm(passage.te), tm = (1.0 - te_share) * std::norm(passage.tm), sum = te + tm;
  const double delay = sum > 0.0 ? (te * passage.te_delay + tm * passage.tm_delay) / sum : 0.0;
  return {te_share * passage.te + (1.0 - te_share) * passage.tm, delay};
}

double detour(const Vec3& offset, double length, double wavelength) {
  const double squared = offset.squaredNorm(), least = kLeastOffset * wavelength;
  return squared > least * least && length > 0.0 ? 0.5 * squared / length : 0.0;
}

}  // namespace echopath
