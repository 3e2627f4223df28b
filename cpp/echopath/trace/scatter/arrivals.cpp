#include "echopath/trace/scatter/arrivals.h"

#include "echopath/trace/sbr/ray_tube.h"

namespace echopath {

bool Arrivals::arrive(Ray& ray, SurfaceHit& surface, TraceStatistics& statistics) const {
  surface.cos_incidence = -surface.point.normal.dot(ray.direction);
  if (surface.cos_incidence < kGrazing) {
    ++statistics.num_grazing;
    return false;
  }
  find_response(ray, surface);
  const bool has_field = ray.coherent && surface.response.coherent > 0;
  if (!has_field) orders_.weigh_mirror(ray, surface, statistics.num_queries);
  if (!ray.holds_zones && !has_field) {
    ++statistics.num_small_mirrors;
    return false;
  }
  if (!ray.is_owned && !finds_owner(ray, surface.point.hit.mesh_id)) return false;
  ++statistics.num_hits;
  record(ray, surface);
  return true;
}

void Arrivals::find_response(const Ray& ray, SurfaceHit& surface) const {
  surface.model = &context_.surfaces.model(surface.point.hit, surface.point.normal);
  surface.mode = mode_along(*surface.model, context_.settings.polarization, ray.direction, surface.point.normal);
  surface.response = surface.model->respond(surface.cos_incidence, surface.mode);
}

// Serves a ray that has met flagged mirrors alone: returns whether its stratum owns the mesh that it meets, or it goes on
// over another mirror.
bool Arrivals::finds_owner(Ray& ray, uint32_t mesh_id) const {
  const bool passes_on = context_.is_passed(ray.stratum, mesh_id) && ray.sequence != kOther && ray.depth < kMaxLegMirrors;
  ray.is_owned = !passes_on && context_.is_owner(ray.stratum, mesh_id, ray.sequence);
  return passes_on || ray.is_owned;
}

void Arrivals::record(Ray& ray, SurfaceHit& surface) const {
  surface.material = &surface.model->material();
  ray.hits[ray.depth++] = surface.point.hit;
  ray.leg_length += surface.point.distance;
  if (context_.surfaces.has_smooth() && ray.coherent) carry_tube(ray, surface, context_.wavelength);
  if (!surface.material->mirror) ray.return_sign.add(*surface.model, surface.mode);
  surface.area = ray.leg_length * ray.leg_length / (ray.leg_density * surface.cos_incidence);
}

}  // namespace echopath
