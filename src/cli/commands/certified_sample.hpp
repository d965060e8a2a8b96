// carom escape --certify-sample: does rounding bias survival?
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "carom/ensemble/paired_escape.hpp"
#include "carom/io/system_file.hpp"
#include "cli/options.hpp"
#include "io/json.hpp"

namespace carom::cli {

/// Flies the first trajectories of an ensemble with the engine and in balls, and compares.
struct CertifiedSample {
  int digits = 10;
  PairedEscapeResult result;
};
/// Throws InputError where a system or an option has no certified form.
CertifiedSample compare_with_certified(const Options&, const LoadedSystem&,
                                       const std::atomic<bool>& stop,
                                       std::function<void(std::uint64_t done)> progress);
io::Json sample_json(const System&, const CertifiedSample&);
/// `rows`: at most so many times in the table.
std::string sample_text(const System&, const CertifiedSample&, std::size_t rows = 12);

int certified_sample(const Options&);

}  // namespace carom::cli
