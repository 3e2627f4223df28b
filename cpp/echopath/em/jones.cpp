#include "echopath/em/jones.h"

#include <cmath>

#include "echopath/em/surface_response.h"

namespace echopath {
namespace {

FieldVector cross(const Vec3& a, const FieldVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// a.b without conjugation.
std::complex<double> dot(const Vec3& a, const FieldVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Unit normal of the plane of two directions; where they are parallel any plane through the first serves.
Vec3 plane_normal(const Vec3& direction, const Vec3& other) {
  const Vec3 across = direction.cross(other);
  const double sine = across.norm();
  return sine > 1e-9 ? Vec3(across / sine) : direction.unitOrthogonal();
}

// An unturned wave and one that is mirrored at the axis, in quadrature: a unitary, symmetric matrix.
FieldVector depolarized(const FieldVector& field, const Vec3& direction, const Vec3& out, const Depolarization& by) {
  const Vec3 first = plane_normal(direction, out), second = direction.cross(first);
  const Vec3 axis = std::cos(by.axis) * first + std::sin(by.axis) * second;
  const FieldVector mirrored = 2.0 * dot(axis, field) * axis.cast<std::complex<double>>() - field;
  const double turned = 2.0 * by.cross_share;
  return std::sqrt(1.0 - turned) * field + std::complex<double>(0.0, std::sqrt(turned)) * mirrored;
}

}  // namespace

TransverseBasis transverse_basis(const Vec3& direction) {
  Vec3 horizontal = Vec3::UnitZ().cross(direction);
  const double length = horizontal.norm();
  horizontal = length > 1e-9 ? Vec3(horizontal / length) : Vec3::UnitX();
  return {horizontal, direction.cross(horizontal)};
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

Eigen::Vector2d transverse_components(const Vec3& polarization, const Vec3& direction) {
  const TransverseBasis basis = transverse_basis(direction);
  const Eigen::Vector2d components(polarization.dot(basis.horizontal), polarization.dot(basis.vertical));
  const double length = components.norm();
  return length > 1e-9 ? Eigen::Vector2d(components / length) : Eigen::Vector2d::Zero();
}

ModeCoefficients mode_coefficients(const Material& material, double frequency, double cos_incidence) {
  if (material.conductor) return {-1.0, 1.0};
  if (material.reflectivity) return {-std::sqrt(*material.reflectivity), std::sqrt(*material.reflectivity)};
  return {respond(material, frequency, cos_incidence, PolarizationMode::kTe).gamma,
          respond(material, frequency, cos_incidence, PolarizationMode::kTm).gamma};
}

FieldVector reflected_field(const FieldVector& incident, const Vec3& direction, const Vec3& normal,
                            const ModeCoefficients& coefficients) {
  const Vec3 te = plane_normal(direction, normal);
  const Vec3 reflected = direction - 2.0 * direction.dot(normal) * normal;
  const Vec3 tm_in = te.cross(direction), tm_out = te.cross(reflected);
  return coefficients.te * dot(te, incident) * te.cast<std::complex<double>>() +
         coefficients.tm * dot(tm_in, incident) * tm_out.cast<std::complex<double>>();
}

FieldVector radiated_field(const FieldVector& incident, const Vec3& direction, const Vec3& normal, const Vec3& out,
                           const ModeCoefficients& coefficients) {
  const FieldVector reflected = reflected_field(incident, direction, normal, coefficients);
  const Vec3 mirrored = direction - 2.0 * direction.dot(normal) * normal;
  const FieldVector electric = cross(normal, FieldVector(incident + reflected));
  const FieldVector magnetic = cross(normal, FieldVector(cross(direction, incident) + cross(mirrored, reflected)));
  return -0.5 * cross(out, FieldVector(electric - cross(out, magnetic)));
}

FieldVector scattered_field(const FieldVector& incident, const Vec3& direction, const Vec3& out, double reflection,
                            const Depolarization& depolarization) {
  FieldVector field = reflection * incident;
  if (depolarization.cross_share > 0) field = depolarized(field, direction, out, depolarization);
  const Vec3 facet = (out - direction).normalized();  // finite: `out` is on the lit side, `direction` comes from there
  return 2.0 * dot(facet, field) * facet.cast<std::complex<double>>() - field;
}

}  // namespace echopath
