// A section for machines and for people.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "carom/analyses/section.hpp"
#include "cli/outcome.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// What the text shows of the first orbits.
class OrbitLines {
 public:
  /// Points of an orbit in order of time; orbit after orbit.
  void add(const std::vector<SectionPoint>&);
  bool empty() const { return lines_.empty(); }
  std::size_t size() const { return lines_.size(); }
  std::string table() const;

 private:
  struct Line {
    std::uint64_t orbit = 0, points = 0;
    double from = 0, to = 0, last_time = 0;
  };
  std::vector<Line> lines_;
};

/// `output`: the archive, or "".
files::Json section_json(const System&, const SectionResult&, const std::string& status,
                         const std::string& output);
/// `verbose`: with the decisions and the digest.
std::string section_text(const System&, const SectionResult&, const OrbitLines&,
                         const std::string& output, bool verbose = false);

struct SectionOutcome final : Outcome {
  using Outcome::Outcome;
  files::Json json() const override { return section_json(system(), result, status(), ""); }
  std::string text() const override;
  std::vector<std::string> doubts() const override;
  void save(const std::string& file, bool force, const std::atomic<bool>& stop) const override;
  const char* status() const { return result.complete ? "completed" : "interrupted"; }

  SectionResult result;
  std::shared_ptr<std::vector<SectionPoint>> points = std::make_shared<std::vector<SectionPoint>>();
};

}  // namespace carom::cli
