#pragma once
// Rules that sort the paths of any record of a scene: what `decompose` takes signals apart by. A frame with keyframes has
// several records, and the same rule sorts each.
#include <functional>
#include <vector>

#include "echopath/label/partition.h"
#include "echopath/label/surfaces.h"

namespace echopath {

// Parts of the same name of several records are one part. The last part is the rest, in all records the same.
using Grouping = std::function<Partition(const Paths&, Job*)>;

// make_partition.
Grouping by_selections(std::vector<NamedSelection> parts);

// find_families.
Grouping by_families(SurfaceMap surfaces);

// What error bars are made from: the coherent and the diffuse paths of each batch of rays, "batch 0 coherent",
// "batch 0 diffuse", ...; last "all batches", the paths by images, which stand in each batch's estimate in full.
Grouping by_batches();
inline constexpr const char* kAllBatches = "all batches";

// The combinations of parts that occur, in order; names joined by kBetweenNames.
Grouping by_all(std::vector<Grouping> groupings);
inline constexpr char kBetweenNames = '\x1f';

}  // namespace echopath
