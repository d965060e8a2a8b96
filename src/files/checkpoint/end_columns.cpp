// How the particles of an ensemble ended, as numbers of the group /fates.
#include "files/checkpoint/ensemble_columns.hpp"

namespace carom::files {

using hdf5::Handle;

FateCounts read_fates(const Handle& group, const std::string& name, std::uint64_t all) {
  FateCounts counts;
  read_numbers(group.get(), counts, name);
  if (counts.all() != all) damaged(name, "'/fates' do not add up to '/fates/trajectories'");
  if (counts.unbounded > counts.escaped)
    damaged(name, "'/fates/unbounded' is more than '/fates/escaped'");
  if (counts.pinned > counts.survived || counts.capped > counts.survived - counts.pinned)
    damaged(name, "'/fates/pinned' and '/fates/capped' are more than '/fates/survived'");
  return counts;
}

}  // namespace carom::files
