#pragma once
// Carries out the steps of a trace: it makes once what all rays share, and shoots the rays in blocks. Internal to the
// module.
#include "echopath/trace/edges/edges_over_planes.h"
#include "echopath/trace/embree/kept_geometry.h"
#include "echopath/trace/mirrors/plane_images.h"
#include "echopath/trace/sbr/sbr.h"
#include "echopath/trace/trace.h"

namespace echopath {

class Tracer {
 public:
  // Raises what `trace` raises. What is kept, and the strata that were fitted before, may be null.
  Tracer(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job,
         KeptGeometry* kept = nullptr, FittedStrata* fitted = nullptr);
  // Shoots all rays; it returns the same record each time. `doubles`, which may be null, and the filter are those of
  // `trace`.
  Paths run(Job* job, PlaneDoubles* doubles = nullptr, const RecordFilter& filter = {}) const;
  int64_t num_rays() const { return plan_.first_ray.back(); }
  int64_t num_blocks() const;
  void shoot_block(int64_t index, PathBlock& block) const;
  // Shoots the rays [begin, end) of the plan, of which `begin` is a multiple of kPacketSize from its start, or where strata
  // have random numbers of their own, from that of its stratum, and appends their paths.
  void shoot(int64_t begin, int64_t end, PathBlock& block) const { shooter_.shoot(begin, end, block); }
  EmbreeScene& geometry() { return geometry_; }
  const EmbreeScene& geometry() const { return geometry_; }
  // These return what all rays share. The record has no paths yet.
  const Paths& without_paths() const { return empty_; }
  const LaunchPlan& plan() const { return plan_; }
  const SbrSettings& sbr() const { return sbr_; }
  const AntennaFrusta& frusta() const { return frusta_; }
  // Returns the paths that need no rays: over flagged mirrors alone, and those of edges where they are asked for.
  std::vector<PathBlock> find_paths_without_rays(Job* job) const;
  // Returns what finds the paths over other planes, from the blocks that it is given.
  PlaneImages plane_images() const;  // the tracer must outlive them
  // Returns what finds which planes light which, from the blocks that it is given, where edges are asked for.
  LitPlanes lit_planes() const;
  // Returns the paths of edges over these planes; none where edges are not asked for.
  std::vector<PathBlock> find_edges(LitPlanes& lit, Job* job) const;

 private:
  EdgeQuery edge_query() const {
    return {*empty_.scene, edges_, edge_estimate_, least_edge_power_, geometry_, mirrors_, sbr_, frusta_};
  }
  std::vector<PathBlock> shoot_ahead(int64_t step, Job* job) const;
  std::vector<const PathBlock*> shoot_wave(int64_t begin, const std::vector<PathBlock>& ahead, int64_t step,
                                           std::vector<PathBlock>& wave, Job* job) const;
  void require_memory(const std::vector<PathBlock>& ahead, const RecordFilter& filter, Job* job) const;
  double kept_share(const std::vector<PathBlock>& blocks, const RecordFilter& filter, Job* job) const;
  LaunchPlan plan_rays(const TraceSettings& settings, FittedStrata* fitted, const Job* job);
  SbrSettings settings_of_rays(const TraceSettings& settings) const;
  void aim_at_points(const TraceSettings& settings, Job* job);
  void pose_edges();
  int64_t num_lattice_blocks() const;

  Paths empty_;  // scene, radar and frame of the record
  int64_t num_rays_to_come_;
  PosedScene pose_;
  Transform world_from_radar_;
  GeometryLoan loan_;
  EmbreeScene& geometry_;
  Vec3 origin_;
  EdgeEstimate edge_estimate_;
  std::vector<PosedEdge> edges_;  // none where edges are not asked for
  double least_edge_power_ = 0.0;
  std::vector<Mirror> mirrors_;
  SbrSettings sbr_;
  AntennaFrusta frusta_;
  LaunchPlan plan_;
  std::vector<std::pair<int64_t, int64_t>> pieces_;  // of the rays by block, where strata have random numbers of their own
  RayShooter shooter_;
};

}  // namespace echopath
