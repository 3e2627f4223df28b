#pragma once
// Shoots and bounces rays in both transport regimes, and connects every hit to the receiver.
//
// Regime C (coherent): a ray carries a field up to its first diffuse hit, and each unflagged hit radiates by physical optics
// over every visible receive leg (connector.h). Regime D (diffuse): from there on it carries power with one random phase per
// diffuse hit. A first diffuse hit is paired with all its visible transmit and receive legs (connector.h), a chain of
// diffuse hits gives both of its orders (diffuse_chain.h). Flagged mirrors radiate diffusely only, by rays of the field of
// view; paths over mirrors alone come from mirror_paths.h. Specular bounces off unflagged surfaces are geometrical optics
// (mirror_orders.h). ray_walk.h joins the parts: packets to the first hits (packet_front.h), from hit to hit (scatterer.h),
// and to the receiver; weight.h tells what paths hold of field vectors. Sources: Ling, Chou, Lee 1989 (SBR);
// Degli-Esposti et al. 2007 (effective roughness); Veach 1997 (balance heuristic).
#include <memory>

#include "echopath/record/blocks/path_block.h"
#include "echopath/trace/frusta/antenna_frusta.h"
#include "echopath/trace/launch/launch.h"
#include "echopath/trace/sbr/sbr_settings.h"

namespace echopath {

class RayShooter {
 public:
  // All but the settings must outlive the shooter.
  RayShooter(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const LaunchPlan& plan,
             const SbrSettings& settings, const AntennaFrusta& frusta);
  ~RayShooter();
  // Traces the rays [begin, end) of the plan and appends their paths. Thread-safe for different blocks.
  void shoot(int64_t begin, int64_t end, PathBlock& block) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace echopath
