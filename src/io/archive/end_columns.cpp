// How the particles of an ensemble ended, as numbers of the group /fates.
#include <fmt/format.h>

#include <type_traits>

#include "io/archive/ensemble_columns.hpp"

namespace carom::io {

using hdf5::Handle;

namespace {

struct Number {
  const char* name;
  std::uint64_t FateCounts::*value;
  const char* text;
};
constexpr Number fates[] = {
    {"survived", &FateCounts::survived, "Still there at the end"},
    {"pinned", &FateCounts::pinned, "Survivors on a cyclotron orbit that never hits"},
    {"escaped", &FateCounts::escaped, "Left through a hole, or to infinity"},
    {"capped", &FateCounts::capped, "Ended by the cap on hits"},
    {"singular", &FateCounts::singular, "Ended where no continuation is defined"},
    {"unbounded", &FateCounts::unbounded, "Escaped to infinity: no wall follows any more"},
    {"lost", &FateCounts::lost, "Internal errors: always 0"},
};

}  // namespace

void write_ends(const Handle& group, const FateCounts& counts, const EnsembleNumbers& numbers,
                const std::string& name) {
  const auto write = [&](const char* column, std::uint64_t value, const char* text) {
    hdf5::write_number(group.get(), column, value, {"1", text}, name);
  };
  write("trajectories", numbers.particles, "All particles of all trajectories");
  for (const Number& fate : fates) write(fate.name, counts.*fate.value, fate.text);
  write("unresolved", counts.unresolved, "Ended where integration could not follow");
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
  for (const Number& fate : fates) counts.*fate.value = read(fate.name);
  counts.unresolved = read_unresolved(group.get(), name);
  EnsembleNumbers numbers{read("trajectories"), read("collisions"), read("digest")};
  if (hdf5::has(group.get(), "contacts")) numbers.contacts = read("contacts");
  return numbers;
}

}  // namespace carom::io
