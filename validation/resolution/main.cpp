// Random systems whose forces are narrow, steep or many, each run by Carom under several schemes
// and compared with an orbit in 34 digits by formulas and a method of this program's own. Every run
// must agree within the error that it states, or say that it does not; the rest is wrong in
// silence.
#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "answer.hpp"

namespace {

using namespace resolution;

const char* const usage =
    "resolution --program PATH [OPTION…]\n"
    "  --seed S         of the systems (1)\n"
    "  --from I         index of the first system (0); system I of a seed is always the same\n"
    "  --count N        number of systems (2000)\n"
    "  --folder F       where the files go (resolution); those of runs that are wrong in silence "
    "stay\n"
    "  --results F      append a line for each run to this file\n"
    "  --chosen         also without step and tolerance: the program chooses\n"
    "  --growth G       orbits end before nearby ones have separated by this factor (1000)\n"
    "  --seconds S      longest time of a run (20)\n"
    "  --jobs J         systems at a time (2)\n"
    "  --self-test      the reference against itself; Carom is not run\n";

struct Options {
  std::string program, folder = "resolution", results;
  std::uint64_t seed = 1, from = 0, count = 2000;
  double growth = 1000.0, seconds = 20.0;
  int jobs = 2;
  bool chosen = false, self_test = false;
};

struct Mode {
  std::string name, integrator;
};

std::string written(double value) {
  char text[40];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

/// A number in [0, 1) from a seed, an index and a purpose.
double drawn(std::uint64_t seed, std::uint64_t index, std::uint64_t purpose) {
  std::uint64_t z = (seed * 0x9e3779b97f4a7c15u) ^ (index * 0xd1342543de82ef95u) ^
                    (purpose * 0xbf58476d1ce4e5b9u);
  for (int round = 0; round < 3; ++round) z = (z ^ (z >> 29)) * 0x94d049bb133111ebu;
  return static_cast<double>(z >> 11) * 0x1p-53;
}

/// The ways in which Carom runs a system. A sensible step is a small part of the time in which the
/// particle goes through the narrowest force; one that is far too long is 2 to 100 times that time.
std::vector<Mode> modes_of(const Options& options, std::uint64_t index, const System& system,
                           const Reference& reference) {
  std::vector<Mode> modes = {{"cvode", "scheme = \"cvode\"\n"},
                             {"arkode", "scheme = \"arkode\"\n"}};
  const struct {
    const char* name;
    double sensible;
  } schemes[] = {{"velocity-verlet", 0.02}, {"blanes-moan-s6", 0.1}, {"blanes-moan-srkn11b", 0.25}};
  const double through = system.scale / reference.fastest;
  // Walls are searched along a step, for which it must not turn too far.
  const double longest =
      std::min(reference.t_end, system.field != 0.0 ? 0.9 / std::fabs(system.field) : 1e30);
  std::uint64_t purpose = 0;
  for (const auto& scheme : schemes) {
    const double sensible =
        std::min(longest, std::max(scheme.sensible * through, reference.t_end / 1e6));
    const double factor = 2.0 * std::pow(50.0, drawn(options.seed, index, ++purpose));
    const double long_step = std::min(longest, through * factor);
    const std::string line = "scheme = \"" + std::string(scheme.name) + "\"\nstep = ";
    modes.push_back({scheme.name, line + written(static_cast<float>(sensible)) + "\n"});
    modes.push_back({std::string(scheme.name) + ", long",
                     line + written(static_cast<float>(long_step)) + "\n"});
  }
  if (options.chosen) modes.push_back({"chosen", ""});
  return modes;
}

class Referee {
 public:
  explicit Referee(Options options) : options_(std::move(options)) {
    std::filesystem::create_directories(options_.folder);
    if (!options_.results.empty()) results_.open(options_.results, std::ios::app);
  }

  int run() {
    std::vector<std::thread> workers;
    for (int i = 0; i < options_.jobs; ++i)
      workers.emplace_back([this] {
        while (true) {
          const std::uint64_t done = next_++;
          if (done >= options_.count) return;
          one(options_.from + done);
        }
      });
    for (std::thread& worker : workers) worker.join();
    print();
    return failures_ == 0 ? 0 : 1;
  }

 private:
  void one(std::uint64_t index) {
    const System system = random_system(options_.seed, index);
    try {
      const Reference reference = reference_orbit(system, options_.growth);
      note_reference(index, system, reference);
      if (options_.self_test)
        test_reference(index, system, reference);
      else
        test_program(index, system, reference);
    } catch (const Undecided& reason) {
      const std::lock_guard lock(mutex_);
      ++without_reference_;
      std::printf("seed %llu, system %llu (%s): no reference: %s\n", as_printed(options_.seed),
                  as_printed(index), system.family.c_str(), reason.what());
    }
  }

  void note_reference(std::uint64_t index, const System& system, const Reference& reference) {
    const std::lock_guard lock(mutex_);
    worst_energy_ = std::max(worst_energy_, reference.energy_change);
    worst_quick_ = std::max(worst_quick_, reference.quick_distance);
    if (reference.energy_change <= 1e-25 && reference.quick_distance <= 1e-11) return;
    ++failures_;
    std::printf(
        "seed %llu, system %llu (%s): REFERENCE IN DOUBT: energy %.1e, from long double %.1e\n",
        as_printed(options_.seed), as_printed(index), system.family.c_str(),
        reference.energy_change, reference.quick_distance);
  }

  void test_reference(std::uint64_t index, const System& system, const Reference& reference) {
    const SelfTest test = self_test(system, reference);
    const std::lock_guard lock(mutex_);
    worst_.finer = std::max(worst_.finer, test.finer);
    worst_.reversed = std::max(worst_.reversed, test.reversed);
    worst_.force = std::max(worst_.force, test.force);
    // Differences of order 8 over a thousandth of the scale err by about 1e-21 of the force.
    const bool good = test.finer <= 1e-25 && test.reversed <= 1e-25 && test.force <= 1e-17;
    failures_ += good ? 0 : 1;
    if (!good || options_.count <= 20)
      std::printf(
          "seed %llu, system %llu (%s): t %.3g, %ld steps, growth %.0f; finer %.1e, reversed %.1e, "
          "force "
          "%.1e%s\n",
          as_printed(options_.seed), as_printed(index), system.family.c_str(), reference.t_end,
          reference.steps, reference.growth, test.finer, test.reversed, test.force,
          good ? "" : "  FAILED");
  }

  void test_program(std::uint64_t index, const System& system, const Reference& reference) {
    int number = 0;
    for (const Mode& mode : modes_of(options_, index, system, reference)) {
      const std::string file = options_.folder + "/" + std::to_string(options_.seed) + "-" +
                               std::to_string(index) + "-" + std::to_string(number++) + ".toml";
      std::ofstream(file) << toml(system, reference.t_end, mode.integrator);
      const Answer answer = ask(options_.program, file, options_.seconds);
      const Judgement judgement = judge(answer, reference);
      const bool failed = judgement.verdict >= Verdict::slow;
      if (!failed) std::filesystem::remove(file);
      const std::lock_guard lock(mutex_);
      ++counts_[system.family][mode.name][static_cast<std::size_t>(judgement.verdict)];
      ++counts_["all"][mode.name][static_cast<std::size_t>(judgement.verdict)];
      if (failed) {
        ++failures_;
        failed_.push_back(line_of(index, system, mode, answer, judgement, reference) + "  " + file);
      }
      if (results_.is_open())
        results_ << line_of(index, system, mode, answer, judgement, reference) << std::endl;
    }
  }

  std::string line_of(std::uint64_t index, const System& system, const Mode& mode,
                      const Answer& answer, const Judgement& judgement,
                      const Reference& reference) const {
    char line[300];
    std::snprintf(
        line, sizeof line,
        "%llu %llu %-8s %-26s %-10s position %.1e of %.1e, velocity %.1e of %.1e, t %.4g, growth "
        "%.0f, %.2f s",
        as_printed(options_.seed), as_printed(index), system.family.c_str(), mode.name.c_str(),
        verdict_names[static_cast<int>(judgement.verdict)], judgement.position,
        judgement.stated_position, judgement.velocity, judgement.stated_velocity, reference.t_end,
        reference.growth, answer.seconds);
    return line;
  }

  void print() const {
    std::printf(
        "reference: largest energy change %.1e, largest distance from long double %.1e, none for "
        "%d "
        "systems\n",
        worst_energy_, worst_quick_, without_reference_);
    if (options_.self_test) {
      std::printf("self-test: half the way %.1e, turned back %.1e, force %.1e; failed %d\n",
                  worst_.finer, worst_.reversed, worst_.force, failures_);
      return;
    }
    for (const std::string& line : failed_) std::printf("%s\n", line.c_str());
    std::printf("%-8s %-26s", "family", "scheme");
    for (const char* name : verdict_names) std::printf(" %10s", name);
    std::printf("\n");
    for (const auto& [family, modes] : counts_) {
      if (family != "all") print(family, modes);
    }
    if (counts_.contains("all")) print("all", counts_.at("all"));
  }

  using Counts = std::map<std::string, std::array<long, verdicts>>;
  static void print(const std::string& family, const Counts& modes) {
    for (const auto& [mode, counts] : modes) {
      std::printf("%-8s %-26s", family.c_str(), mode.c_str());
      for (const long count : counts) std::printf(" %10ld", count);
      std::printf("\n");
    }
  }

  static unsigned long long as_printed(std::uint64_t number) { return number; }

  Options options_;
  std::atomic<std::uint64_t> next_{0};
  std::mutex mutex_;
  std::ofstream results_;
  std::map<std::string, Counts> counts_;
  std::vector<std::string> failed_;
  double worst_energy_ = 0.0, worst_quick_ = 0.0;
  SelfTest worst_;
  int failures_ = 0, without_reference_ = 0;
};

bool read_options(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--chosen" || name == "--self-test") {
      (name == "--chosen" ? options.chosen : options.self_test) = true;
      continue;
    }
    if (i + 1 >= argc) return false;
    const char* value = argv[++i];
    if (name == "--program") {
      options.program = value;
    } else if (name == "--folder") {
      options.folder = value;
    } else if (name == "--results") {
      options.results = value;
    } else if (name == "--growth") {
      options.growth = std::atof(value);
    } else if (name == "--seconds") {
      options.seconds = std::atof(value);
    } else if (name == "--seed") {
      options.seed = std::strtoull(value, nullptr, 10);
    } else if (name == "--from") {
      options.from = std::strtoull(value, nullptr, 10);
    } else if (name == "--count") {
      options.count = std::strtoull(value, nullptr, 10);
    } else if (name == "--jobs") {
      options.jobs = std::atoi(value);
    } else {
      return false;
    }
  }
  return options.self_test || !options.program.empty();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read_options(argc, argv, options)) {
    std::cerr << usage;
    return 2;
  }
  try {
    return Referee(options).run();
  } catch (const std::exception& error) {
    std::cerr << "resolution: " << error.what() << '\n';
    return 1;
  }
}
