// How the particles of an ensemble ended, as numbers of the group /fates.
#include <fmt/format.h>

#include <algorithm>

#include "io/archive/ensemble_columns.hpp"

namespace carom::io {

using hdf5::Handle;

namespace {

struct FateNumber {
  const char* name;
  std::uint64_t FateCounts::*value;
  const char* text;
};
constexpr FateNumber fate_numbers[] = {
    {"survived", &FateCounts::survived, "Still there at the end"},
    {"pinned", &FateCounts::pinned, "Survivors on a cyclotron orbit that never hits"},
    {"capped", &FateCounts::capped, "Survivors ended by the cap on hits"},
    {"escaped", &FateCounts::escaped, "Left through a hole, or to infinity"},
    {"unbounded", &FateCounts::unbounded, "Escaped to infinity: no wall follows any more"},
    {"singular", &FateCounts::singular, "Ended where no continuation is defined"},
    {"unresolved", &FateCounts::unresolved, "Ended where integration could not follow"},
    {"lost", &FateCounts::lost, "Internal errors: always 0"},
};

}  // namespace

void write_fates(const Handle& group, const FateCounts& counts, const std::string& name) {
  for (const FateNumber& fate : fate_numbers)
    hdf5::write_number(group.get(), fate.name, counts.*fate.value, {"1", fate.text}, name);
}

FateCounts read_fates(const Handle& group, const std::string& name, std::uint64_t all) {
  FateCounts counts;
  for (const FateNumber& fate : fate_numbers) {
    // Earlier builds called unresolved particles lost, and left survivors out of sections.
    const bool later = fate.value == &FateCounts::unresolved || fate.value == &FateCounts::survived;
    if (later && !hdf5::has(group.get(), fate.name)) continue;
    counts.*fate.value = read_number<std::uint64_t>(group.get(), fate.name,
                                                    fmt::format("/fates/{}", fate.name), name);
  }
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
    return read_number<std::uint64_t>(group.get(), column, fmt::format("/fates/{}", column), name);
  };
  EnsembleNumbers numbers{read("trajectories"), read("collisions"), read("digest")};
  counts = read_fates(group, name, numbers.particles);
  if (hdf5::has(group.get(), "contacts")) numbers.contacts = read("contacts");
  return numbers;
}

}  // namespace carom::io
