// /fates of the archive of a section, where writing and reading meet.
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
    {"pinned", &SectionResult::pinned, "On a cyclotron orbit that never hits"},
    {"escaped", &SectionResult::escaped, "Left through a hole, or to infinity"},
    {"capped", &SectionResult::capped, "Ended by the cap on hits"},
    {"singular", &SectionResult::singular, "Ended where no continuation is defined"},
    {"unbounded", &SectionResult::unbounded, "Escaped to infinity: no wall follows any more"},
    {"unresolved", &SectionResult::unresolved, "Ended where integration could not follow"},
    {"lost", &SectionResult::lost, "Internal errors: always 0"},
    {"digest", &SectionResult::digest,
     "Sum of a hash of each orbit's points: equal digests, equal bits"},
};

}  // namespace carom::io
