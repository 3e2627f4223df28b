// Finds the matrices of all pairs of legs of a hit; each leg is followed once.
#include <cmath>

#include "echopath/trace/sbr/weight.h"

namespace echopath {
namespace {

// Returns a.b without conjugation.
std::complex<double> along(const VectorOf<double>& a, const FieldVector& b) { return a.x * b[0] + a.y * b[1] + a.z * b[2]; }

std::complex<double> as_complex(const ComplexOf<double>& z) { return {z.re, z.im}; }

// Returns the modes of a wave that travels along `arrival`.
ModesIn modes_of(const SurfaceHit& surface, const Vec3& arrival, const FieldPair& fields, double cos_incidence) {
  const double diffuse = diffuse_coefficient(surface.model->respond(cos_incidence, PolarizationMode::kTe));
  ModesIn found{unpacked(arrival), mode_axes(unpacked(arrival), unpacked(surface.point.normal)), {}, {}};
  for (size_t launch = 0; launch < 2; ++launch) {
    found.te[launch] = diffuse * along(found.axes.te, fields[launch]);
    found.tm[launch] = diffuse * along(found.axes.tm, fields[launch]);
  }
  return found;
}

JonesMatrix pair_matrix(const HitMatrix& matrix, const ModesIn& in, const AxesOut& out) {
  JonesMatrix found;
  for (size_t launch = 0; launch < 2; ++launch) {
    const std::complex<double> h = as_complex(matrix.h_te) * in.te[launch] + as_complex(matrix.h_tm) * in.tm[launch];
    const std::complex<double> v = as_complex(matrix.v_te) * in.te[launch] + as_complex(matrix.v_tm) * in.tm[launch];
    for (size_t component = 0; component < 2; ++component) {
      found[2 * component + launch] = std::complex<float>(out.horizontal[component] * h + out.vertical[component] * v);
    }
  }
  return found;
}

}  // namespace

void JonesWeight::find_modes_in(Connection& at) const {
  const SurfaceHit& surface = at.surface;
  std::vector<ModesIn>& modes = at.fields.modes_in;
  modes.clear();
  for (const Leg& in : at.legs.transmit) {
    modes.push_back(modes_of(surface, -in.to_antenna, incident_over(in), in.to_antenna.dot(surface.point.normal)));
  }
  modes.push_back(modes_of(surface, at.ray.direction, at.ray.fields, surface.cos_incidence));
}

void JonesWeight::find_axes_out(Connection& at) const {
  at.fields.axes_out.clear();
  for (const Leg& leg : at.legs.receive) {
    AxesOut& out = at.fields.axes_out.emplace_back();
    out.direction = unpacked(leg.to_antenna);
    out.across = basis_across(out.direction);
    for (size_t component = 0; component < 2; ++component) {
      out.horizontal[component] = along(out.across.horizontal, at.axes_of(leg)[component]);
      out.vertical[component] = along(out.across.vertical, at.axes_of(leg)[component]);
    }
  }
}

void JonesWeight::add_pair_matrices(Connection& at) const {
  const SurfaceHit& surface = at.surface;
  find_modes_in(at);
  find_axes_out(at);
  const double turn = kPi * surface.samples.axis_sample, cosine = std::cos(turn), sine = std::sin(turn);
  const ModeMixing mixing = mixing_of(surface.material->cross_polarization);
  const PathFan& fan = at.block.fans.back();
  const std::vector<Leg>&transmit = at.legs.transmit, &receive = at.legs.receive;
  for (size_t i = 0; i <= transmit.size(); ++i) {
    const ModesIn& in = at.fields.modes_in[i];
    const auto hits_in = static_cast<uint32_t>(i < transmit.size() ? transmit[i].num_bounces : at.ray.depth - 1);
    for (size_t j = 0; j < receive.size(); ++j) {
      if (!fan.fits(hits_in, static_cast<uint32_t>(receive[j].num_bounces))) continue;
      const AxesOut& out = at.fields.axes_out[j];
      const HitGeometryOfModes hit{in.direction, unpacked(surface.point.normal), out.direction, in.axes, out.across};
      const HitMatrix matrix = scattered_modes(hit, 1.0, mixing, scattering_axis(hit, cosine, sine));
      at.block.add_pair_jones(pair_matrix(matrix, in, out));
    }
  }
}

}  // namespace echopath
