// What /fates of the archive of a section holds besides the fates, where writing and reading meet.
#pragma once

#include <cstdint>

#include "carom/ensemble/section_run.hpp"

namespace carom::io {

struct SectionNumber {
  const char* name;
  std::uint64_t SectionResult::*value;
  const char* text;
};
inline constexpr SectionNumber section_numbers[] = {
    {"orbits", &SectionResult::orbits, "Trajectories followed to their end"},
    {"points", &SectionResult::points, "Points of all orbits"},
    {"collisions", &SectionResult::collisions, "Reflections of all orbits"},
    {"incomplete", &SectionResult::incomplete, "Particles with fewer points than asked for"},
    {"digest", &SectionResult::digest,
     "Sum of a hash of each orbit's points: equal digests, equal bits"},
};

}  // namespace carom::io
