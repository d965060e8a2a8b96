// /trust of a run's archive: up to where each particle can be trusted, and what a continued run
// needs.
#pragma once

#include <string>
#include <vector>

#include "carom/analyses/run.hpp"
#include "files/hdf5/hdf5.hpp"

namespace carom::analyses {

/// Makes the datasets; they are filled when the run ends.
void create_trust(hid_t group, std::size_t particles, const std::string& file);
void write_trust(hid_t group, const std::vector<RunEnd>&, const std::string& file);
/// Into the progress of each particle, whose states are read already.
void read_trust(hid_t group, std::vector<ParticleProgress>&, const std::string& file);

}  // namespace carom::analyses
