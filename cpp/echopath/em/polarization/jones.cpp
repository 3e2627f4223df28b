#include "echopath/em/polarization/jones.h"

#include <cmath>

#include "echopath/base/packed.h"
#include "echopath/base/plane.h"
#include "echopath/em/polarization/hit_modes.h"

namespace echopath {
namespace {

// Returns a.b without conjugation.
std::complex<double> dot(const Vec3& a, const FieldVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Returns the unit normal of the plane of two directions; where they are parallel, any plane through the first serves.
Vec3 plane_normal(const Vec3& direction, const Vec3& other) {
  const Vec3 across = direction.cross(other);
  const double sine = across.norm();
  return sine > 1e-9 ? Vec3(across / sine) : direction.unitOrthogonal();
}

HitGeometryOfModes geometry_of(const Vec3& direction, const Vec3& normal, const Vec3& out) {
  return hit_geometry(unpacked(direction), unpacked(normal), unpacked(out));
}

// Returns what a hit makes of a field, as a vector across its outgoing direction.
FieldVector through(const HitGeometryOfModes& hit, const HitMatrix& matrix, const FieldVector& incident) {
  const std::complex<double> te = dot(packed(hit.modes.te), incident), tm = dot(packed(hit.modes.tm), incident);
  const auto along = [&](const ComplexOf<double>& of_te, const ComplexOf<double>& of_tm) {
    return std::complex<double>(of_te.re, of_te.im) * te + std::complex<double>(of_tm.re, of_tm.im) * tm;
  };
  return along(matrix.h_te, matrix.h_tm) * packed(hit.across.horizontal).cast<std::complex<double>>() +
         along(matrix.v_te, matrix.v_tm) * packed(hit.across.vertical).cast<std::complex<double>>();
}

}  // namespace

TransverseBasis transverse_basis(const Vec3& direction) {
  const BasisAcross basis = basis_across(unpacked(direction));
  return {packed(basis.horizontal), packed(basis.vertical)};
}

FieldPair launched_fields(const Vec3& direction) {
  const TransverseBasis basis = transverse_basis(direction);
  return {basis.horizontal.cast<std::complex<double>>(), basis.vertical.cast<std::complex<double>>()};
}

JonesMatrix arriving_components(const FieldPair& fields, const Vec3& direction) {
  return components(fields, launched_fields(direction));
}

JonesMatrix components(const FieldPair& fields, const FieldPair& axes) {
  JonesMatrix matrix;
  for (size_t row = 0; row < 2; ++row) {
    for (size_t launch = 0; launch < 2; ++launch) {
      const std::complex<double> along = axes[row].transpose() * fields[launch];
      matrix[2 * row + launch] = std::complex<float>(along);
    }
  }
  return matrix;
}

FieldVector reflected_field(const FieldVector& incident, const Vec3& direction, const Vec3& normal,
                            const ModeCoefficients& coefficients) {
  const Vec3 te = plane_normal(direction, normal);
  const Vec3 reflected = mirrored(direction, normal);
  const Vec3 tm_in = te.cross(direction), tm_out = te.cross(reflected);
  return coefficients.te * dot(te, incident) * te.cast<std::complex<double>>() +
         coefficients.tm * dot(tm_in, incident) * tm_out.cast<std::complex<double>>();
}

FieldVector radiated_field(const FieldVector& incident, const Vec3& direction, const Vec3& normal, const Vec3& out,
                           const ModeCoefficients& coefficients) {
  const HitGeometryOfModes hit = geometry_of(direction, normal, out);
  const ComplexOf<double> te{coefficients.te.real(), coefficients.te.imag()},
      tm{coefficients.tm.real(), coefficients.tm.imag()};
  return through(hit, radiated_modes(hit, te, tm), incident);
}

FieldVector scattered_field(const FieldVector& incident, const Vec3& direction, const Vec3& out, double reflection,
                            const Depolarization& depolarization) {
  const HitGeometryOfModes hit = geometry_of(direction, -direction, out);  // both modes are scattered alike: any axes serve
  const AxisInModes axis = scattering_axis(hit, std::cos(depolarization.axis), std::sin(depolarization.axis));
  return through(hit, scattered_modes(hit, reflection, mixing_of(depolarization.cross_share), axis), incident);
}

}  // namespace echopath
