#include "echopath/validity/legs/coefficients.h"

#include <algorithm>

#include "echopath/em/polarization/mirrored_fields.h"
#include "echopath/trace/mirrors/mirrors.h"
#include "echopath/trace/sbr/weight.h"

namespace echopath {

bool PathAtTime::is_as(const PathAtTime& other) const {
  const auto is_alike = [](const PosedHit& a, const PosedHit& b) { return a.point == b.point && a.normal == b.normal; };
  return start == other.start && end == other.end && std::equal(hits, hits + path.count, other.hits, is_alike);
}

Coefficients::Coefficients(const Paths& paths, double frequency)
    : models_(*paths.scene, frequency), is_polarized_(!paths.jones.empty()), polarization_(paths.mode_polarization()) {}

// The matrix of a polarised path turns with the surfaces, whatever they are made of.
bool Coefficients::follow_angles(const LocalPath& path) const {
  if (path.diffuse != 0 || path.edge >= 0 || path.count == 0) return false;
  if (is_polarized_) return true;
  for (int k = 0; k < path.count; ++k) {
    if (!models_.front(path.hits[k].mesh_id).is_constant()) return true;
  }
  return false;
}

// The normals of posed hits are those of their triangles' winding.
const SurfaceModel& Coefficients::model(const PathAtTime& at, int k, const Vec3& direction) const {
  return models_.from(at.path.hits[k].mesh_id, [&] { return direction.dot(at.hits[k].normal) > 0; });
}

std::complex<double> Coefficients::product(const PathAtTime& at) const {
  std::complex<double> out = 1.0;
  ReturnSign sign;
  for_each_hit(at.path, at.hits, at.start, at.end, [&](int k, const Vec3& arrival, const Vec3&) {
    const SurfaceModel& surface = model(at, k, arrival);
    const Vec3 normal = lit_normal(arrival, at.hits[k].normal);
    const bool is_image = at.path.is_image(k);
    const SurfaceResponse response = is_image ? respond_as_mirror(surface, polarization_, arrival, normal)
                                              : respond_along(surface, polarization_, arrival, normal);
    if (!is_image) sign.add(surface, mode_along(surface, polarization_, arrival, normal));
    out *= response.gamma * response.coherent;
  });
  return at.path.first_material < 0 ? out : out * sign.value();
}

// Bounces reflect what arrives; the last material point radiates toward what follows.
JonesMatrix Coefficients::matrix(const PathAtTime& at) const {
  FieldPair fields;
  Vec3 last = Vec3::Zero();
  for_each_hit(at.path, at.hits, at.start, at.end, [&](int k, const Vec3& arrival, const Vec3& departure) {
    if (k == 0) fields = launched_fields(arrival);
    Vec3 direction = arrival;
    const SurfaceModel& surface = model(at, k, arrival);
    if (k == at.path.last_material) {
      const Vec3 normal = lit_normal(arrival, at.hits[k].normal);
      const double cosine = -arrival.dot(normal), coherent = surface.respond(cosine, PolarizationMode::kTe).coherent;
      radiate_fields(fields, arrival, normal, departure, surface, coherent * polarized_scale(cosine, normal.dot(departure)));
    } else {
      carry_over_mirror(fields, direction, at.hits[k].normal, surface);
    }
    last = departure;
  });
  return arriving_components(fields, last);
}

}  // namespace echopath
