// Everything that makes the matrices of polarised paths (Paths::jones) along a ray.
//
// Coherent paths hold the true reflections and the vector form of physical optics. Diffuse paths hold the true reflections of
// their mirrors and specular bounces, and at each diffuse hit the split of power between both polarisations
// (em/jones.h, scattered_field). In a chain of diffuse hits these matrices are multiplied: the mean power is that of every
// split in turn, the phases between two polarisations are those of one chance.
#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/trace/sbr_state.h"

namespace echopath {
namespace {

// Fields behind a mirror or specular bounce of the given specular share of power.
void reflect_all(FieldPair& fields, const Vec3& direction, const Vec3& normal, const SurfaceModel& model, double specular_share) {
  const ModeCoefficients modes = model.modes(-direction.dot(normal));
  for (FieldVector& field : fields) field = std::sqrt(specular_share) * reflected_field(field, direction, normal, modes);
}

}  // namespace

// Before the ray's direction changes.
void RayShooter::reflect_polarized(const Ray& ray, const Surface& surface, FieldPair& fields) const {
  const double coherent = surface.response.coherent;
  reflect_all(fields, ray.direction, surface.point.normal, *surface.model, coherent * coherent);
}

void RayShooter::scatter_polarized(Ray& ray, const Surface& surface, const Vec3& out) const {
  ray.polarized = scattered(surface, ray.polarized, ray.direction, out);
}

// What a diffuse hit makes of fields that travel along `in`. Its random axis is bound to the hit, like its phase.
FieldPair RayShooter::scattered(const Surface& surface, const FieldPair& fields, const Vec3& in,
                                const Vec3& out) const {
  const double cos_incidence = -in.dot(surface.point.normal);
  const double reflection = diffuse_coefficient(surface.model->respond(cos_incidence, PolarizationMode::kTe));
  Depolarization turn{surface.material->cross_polarization, 0.0};
  if (turn.cross_share > 0) turn.axis = kPi * surface.chance.axis_coin;
  FieldPair out_fields;
  for (size_t launch = 0; launch < 2; ++launch) {
    out_fields[launch] = scattered_field(fields[launch], in, out, reflection, turn);
  }
  return out_fields;
}

// The transpose of what the hit makes of fields that come along -`out` and leave along -`in`: a chain of such hits, read
// from its other end.
FieldPair RayShooter::scattered_back(const Surface& surface, const FieldPair& fields, const Vec3& in,
                                     const Vec3& out) const {
  const FieldPair axes = launched_fields(out);
  const FieldPair back = scattered(surface, axes, -out, -in);
  FieldPair out_fields;
  for (size_t launch = 0; launch < 2; ++launch) {
    const std::complex<double> along[] = {back[0].transpose() * fields[launch], back[1].transpose() * fields[launch]};
    out_fields[launch] = along[0] * axes[0] + along[1] * axes[1];
  }
  return out_fields;
}

// What fields at the antenna become on the way over a leg to its surface point.
FieldPair RayShooter::fields_over(const Leg& leg, FieldPair fields) const {
  Vec3 direction = leg.at_antenna;
  for (int k = leg.num_bounces; k-- > 0;) {
    const LegBounce& bounce = leg.bounces[static_cast<size_t>(k)];
    const Mirror& mirror = mirrors_[static_cast<size_t>(bounce.mirror)];
    reflect_all(fields, direction, bounce.normal, models_[mirror.mesh_id], bounce.specular_share);
    direction = mirror.reflect(direction);
  }
  return fields;
}

// Fields at a surface point of launches along a leg to it.
FieldPair RayShooter::incident_over(const Leg& leg) const { return fields_over(leg, launched_fields(leg.at_antenna)); }

// Along which of the fields that leave a surface point a receiver at the end of a leg sees its two components: by
// reciprocity what its own axes become on the way to the point.
FieldPair RayShooter::axes_over(const Leg& leg) const { return fields_over(leg, launched_fields(-leg.at_antenna)); }

void RayShooter::find_receive_axes(Scratch& scratch) const {
  scratch.axes.clear();
  for (const Leg& leg : scratch.receive) scratch.axes.push_back(axes_over(leg));
}

JonesMatrix RayShooter::coherent_matrix(const Ray& ray, const Surface& surface, const Leg& leg, const FieldPair& axes) const {
  const ModeCoefficients modes = surface.model->modes(surface.cos_incidence);
  const double scale = surface.response.coherent * polarized_scale(surface.cos_incidence, surface.point.normal.dot(leg.to_antenna));
  FieldPair fields;
  for (size_t launch = 0; launch < 2; ++launch) {
    fields[launch] = scale * radiated_field(ray.polarized[launch], ray.direction, surface.point.normal, leg.to_antenna, modes);
  }
  return components(fields, axes);
}

JonesMatrix RayShooter::diffuse_matrix(const Ray& ray, const Surface& surface, const Leg& leg, const FieldPair& axes) const {
  return components(scattered(surface, ray.polarized, ray.direction, leg.to_antenna), axes);
}

// From the receiver along the ray's way to the transmitter at the end of `leg`, for the opposite order of its chain.
JonesMatrix RayShooter::opposite_matrix(const Ray& ray, const Surface& surface, const Leg& leg, const Chain& chain) const {
  return components(scattered_back(surface, chain.fields, ray.direction, leg.to_antenna), axes_over(leg));
}

namespace {

// a.b without conjugation.
std::complex<double> along(const VectorOf<double>& a, const FieldVector& b) { return a.x * b[0] + a.y * b[1] + a.z * b[2]; }

std::complex<double> as_complex(const ComplexOf<double>& z) { return {z.re, z.im}; }

}  // namespace

// Of a wave that travels along `arrival`.
RayShooter::ModesIn RayShooter::modes_in(const Surface& surface, const Vec3& arrival, const FieldPair& fields,
                                         double diffuse) const {
  ModesIn found{unpacked(arrival), mode_axes(unpacked(arrival), unpacked(surface.point.normal)), {}, {}};
  for (size_t launch = 0; launch < 2; ++launch) {
    found.te[launch] = diffuse * along(found.axes.te, fields[launch]);
    found.tm[launch] = diffuse * along(found.axes.tm, fields[launch]);
  }
  return found;
}

// Of all pairs of legs, each of which is followed once. The ray's own way to the hit is the last of the transmit legs.
void RayShooter::add_pair_matrices(const Ray& ray, const Surface& surface, Scratch& scratch, PathBlock& block) const {
  const auto diffuse_toward = [&](double cosine) {
    return diffuse_coefficient(surface.model->respond(cosine, PolarizationMode::kTe));
  };
  scratch.modes_in.clear();
  for (const Leg& in : scratch.transmit) {
    const double diffuse = diffuse_toward(in.to_antenna.dot(surface.point.normal));
    scratch.modes_in.push_back(modes_in(surface, -in.to_antenna, incident_over(in), diffuse));
  }
  scratch.modes_in.push_back(modes_in(surface, ray.direction, ray.polarized, diffuse_toward(surface.cos_incidence)));
  scratch.axes_out.clear();
  for (size_t i = 0; i < scratch.receive.size(); ++i) {
    AxesOut& out = scratch.axes_out.emplace_back();
    out.direction = unpacked(scratch.receive[i].to_antenna);
    out.across = basis_across(out.direction);
    for (size_t component = 0; component < 2; ++component) {
      out.horizontal[component] = along(out.across.horizontal, scratch.axes[i][component]);
      out.vertical[component] = along(out.across.vertical, scratch.axes[i][component]);
    }
  }
  const double turn = kPi * surface.chance.axis_coin, cosine = std::cos(turn), sine = std::sin(turn);
  const ModeMixing mixing = mixing_of(surface.material->cross_polarization);
  const PathFan& fan = block.fans.back();
  for (size_t i = 0; i < scratch.modes_in.size(); ++i) {
    const ModesIn& in = scratch.modes_in[i];
    const auto hits_in = static_cast<uint32_t>(i < scratch.transmit.size() ? scratch.transmit[i].num_bounces : ray.depth - 1);
    for (size_t j = 0; j < scratch.receive.size(); ++j) {
      if (!fan.fits(hits_in, static_cast<uint32_t>(scratch.receive[j].num_bounces))) continue;
      const AxesOut& out = scratch.axes_out[j];
      const HitGeometryOfModes hit{in.direction, unpacked(surface.point.normal), out.direction, in.axes, out.across};
      const HitMatrix matrix = scattered_modes(hit, 1.0, mixing, scattering_axis(hit, cosine, sine));
      JonesMatrix found;
      for (size_t launch = 0; launch < 2; ++launch) {
        const std::complex<double> h = as_complex(matrix.h_te) * in.te[launch] + as_complex(matrix.h_tm) * in.tm[launch];
        const std::complex<double> v = as_complex(matrix.v_te) * in.te[launch] + as_complex(matrix.v_tm) * in.tm[launch];
        for (size_t component = 0; component < 2; ++component) {
          found[2 * component + launch] = std::complex<float>(out.horizontal[component] * h + out.vertical[component] * v);
        }
      }
      block.add_pair_jones(found);
    }
  }
}

}  // namespace echopath
