#include "echopath/em/polarization/mirrored_fields.h"

#include "echopath/base/plane.h"

namespace echopath {

void reflect_fields(std::span<FieldVector> fields, const Vec3& direction, const Vec3& normal, const SurfaceModel& model,
                    double coherent) {
  const ModeCoefficients modes = model.modes(-direction.dot(normal));
  for (FieldVector& field : fields) field = coherent * reflected_field(field, direction, normal, modes);
}

void radiate_fields(std::span<FieldVector> fields, const Vec3& direction, const Vec3& normal, const Vec3& out,
                    const SurfaceModel& model, double scale) {
  const ModeCoefficients modes = model.modes(-direction.dot(normal));
  for (FieldVector& field : fields) field = scale * radiated_field(field, direction, normal, out, modes);
}

void carry_over_mirror(std::span<FieldVector> fields, Vec3& direction, const Vec3& normal, const SurfaceModel& model) {
  const Vec3 lit = lit_normal(direction, normal);
  reflect_fields(fields, direction, lit, model, model.respond(-direction.dot(lit), PolarizationMode::kTe).coherent);
  direction = mirrored(direction, lit);
}

}  // namespace echopath
