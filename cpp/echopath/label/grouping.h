#pragma once
// Defines rules that sort the paths of any record of a scene; `decompose` splits signals by them. A frame with keyframes has
// several records, and the same rule sorts each.
#include <functional>
#include <vector>

#include "echopath/label/partition.h"

namespace echopath {

// A grouping sorts paths into parts. Parts of the same name in several records are one part. The last part is the rest, the
// same in all records; by_all has none.
using Grouping = std::function<Partition(const Paths&, Job*)>;

// Groups paths by the first selection that takes them (make_partition).
Grouping by_selections(std::vector<NamedSelection> parts);

// Groups the paths for error bars: the coherent and the diffuse paths of each batch of rays, "batch 0 coherent", "batch 0
// diffuse", ...; the last group, "all batches", holds the paths by images, which count in full in each batch's estimate.
Grouping by_batches();
inline constexpr const char* kAllBatches = "all batches";

// Groups by the combinations of parts that occur, in order; kBetweenNames joins their names.
Grouping by_all(std::vector<Grouping> groupings);
inline constexpr char kBetweenNames = '\x1f';

}  // namespace echopath
