// How the particles of an ensemble ended, as numbers of the group /fates.
#include <algorithm>

#include "io/archive/ensemble_columns.hpp"

namespace carom::io {

using hdf5::Handle;

void write_fates(const Handle& group, const FateCounts& counts, const std::string& name) {
  write_numbers(group.get(), counts, name);
}

FateCounts read_fates(const Handle& group, const std::string& name, std::uint64_t all) {
  FateCounts counts;
  read_numbers(group.get(), counts, name);
  // Earlier builds called unresolved particles lost, and left survivors out of sections.
  if (!hdf5::has(group.get(), "survived"))
    counts.survived = all - std::min(all, counts.all());
  else if (counts.capped > 0 && counts.all() + counts.capped == all)
    counts.survived += counts.capped;  // which earlier builds did not count among them
  if (counts.all() != all) damaged(name, "'/fates' do not add up to '/fates/trajectories'");
  if (counts.unbounded > counts.escaped)
    damaged(name, "'/fates/unbounded' is more than '/fates/escaped'");
  if (counts.pinned > counts.survived || counts.capped > counts.survived - counts.pinned)
    damaged(name, "'/fates/pinned' and '/fates/capped' are more than '/fates/survived'");
  return counts;
}

void write_ends(const Handle& group, const FateCounts& counts, const EnsembleNumbers& numbers,
                const std::string& name) {
  const auto write = [&](const char* column, std::uint64_t value, const char* text) {
    hdf5::write_number(group.get(), column, value, {"1", text}, name);
  };
  write("trajectories", numbers.particles, "All particles of all trajectories");
  write_fates(group, counts, name);
  write("collisions", numbers.collisions, "Reflections of all particles");
  if (numbers.contacts)
    write("contacts", *numbers.contacts, "Contacts of hard discs, each pair once");
  write("digest", numbers.digest,
        "Sum of a hash of each trajectory's end: other ends, another digest");
}

EnsembleNumbers read_ends(const Handle& group, const std::string& name, FateCounts& counts) {
  const auto read = [&](const char* column) {
    return read_number<std::uint64_t>(group.get(), column, name);
  };
  EnsembleNumbers numbers{read("trajectories"), read("collisions"), read("digest")};
  counts = read_fates(group, name, numbers.particles);
  if (hdf5::has(group.get(), "contacts")) numbers.contacts = read("contacts");
  return numbers;
}

}  // namespace carom::io
