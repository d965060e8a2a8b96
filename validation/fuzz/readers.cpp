// Feeds damaged files to the readers within one process, thousands a second; readers.py starts it
// and goes on after a crash. One line a case: INDEX VERDICT, and a word on it. Verdicts are those
// of fuzz.py; `changed`: a damaged file was read, and gave something else than was written.
//
//   readers systems                        cases from standard input: "INDEX BYTES\n" and the bytes
//   readers archives FOLDER SEED FROM COUNT
//                                          FOLDER/NAME/a.h5 or FOLDER/NAME/a.h5.part, as carom left
//                                          them; a case damages one file of one NAME
//   readers names FOLDER SEED FROM COUNT   only says what would be damaged
#include <hdf5.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <new>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "carom/analyses/compare.hpp"
#include "carom/analyses/kinds.hpp"
#include "carom/analyses/orbits.hpp"
#include "carom/analyses/relax.hpp"
#include "carom/analyses/run/archive.hpp"
#include "carom/analyses/run/certified_archive.hpp"
#include "carom/analyses/section.hpp"
#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/files/system_file.hpp"
#include "files/checkpoint/sweep_archive.hpp"
#include "files/checkpoint/work_folder.hpp"

namespace carom {
namespace {

namespace fs = std::filesystem;

// Seconds of a processor. A hundred thousand random discs, which the guide has, take 1.6 s, and a
// system is read three times. (A signal ends the program while it reads.) The allocator of
// AddressSanitizer makes that 25 s.
#ifdef __SANITIZE_ADDRESS__
constexpr double patience = 60.0;
#else
constexpr double patience = 10.0;
#endif
constexpr std::int64_t most_memory = std::int64_t{2} << 20;  // kB

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::int64_t largest_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Runs a case and prints its line. `read` returns its verdict.
void judge(std::uint64_t index, const std::function<std::string()>& read) {
  const double begin = cpu_seconds();
  const std::int64_t before = largest_memory();
  std::string verdict;
  try {
    verdict = read();
  } catch (const std::bad_alloc&) {
    verdict = "memory refused";
  } catch (const InternalError& error) {
    verdict = "internal " + first_line(error.what());
  } catch (const std::exception& error) {
    verdict = "crash " + first_line(error.what());
  }
  const double seconds = cpu_seconds() - begin;
  if (seconds > patience) verdict = "deaf after " + std::to_string(seconds) + " s: " + verdict;
  if (largest_memory() > most_memory && before <= most_memory)
    verdict = "memory " + std::to_string(largest_memory() >> 10) + " MB: " + verdict;
  std::cout << index << ' ' << verdict << std::endl;
}

// ---- systems ----

std::multiset<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::multiset<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.insert(line);
  return lines;
}

std::string read_one_system(const std::string& text) {
  try {
    const LoadedSystem loaded = read_system(text, "fuzz.toml");
    // Sections that were left out may stand elsewhere the first time.
    const std::string again = read_system(loaded.resolved_toml, "again").resolved_toml;
    const bool same = lines_of(again) == lines_of(loaded.resolved_toml) &&
                      read_system(again, "once more").resolved_toml == again;
    return same ? "read" : "changed the resolved system reads as another";
  } catch (const InputError& error) {
    const bool placed = error.place().file == "fuzz.toml" || !error.place().key.empty();
    if (placed && !error.problem().empty()) return "refused";
    return "place " + first_line(error.what());
  }
}

int systems() {
  std::uint64_t index = 0;
  std::size_t size = 0;
  while (std::cin >> index >> size) {
    std::cin.get();
    std::string text(size, '\0');
    std::cin.read(text.data(), static_cast<std::streamsize>(size));
    judge(index, [&] { return read_one_system(text); });
  }
  return 0;
}

// ---- archives ----

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t n) {
    state_ += 0x9e3779b97f4a7c15u;  // splitmix64
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<std::size_t>((z ^ (z >> 31)) % n);
  }

 private:
  std::uint64_t state_;
};

std::string damaged(std::string bytes, Chance& chance) {
  constexpr std::size_t lengths[] = {1, 2, 4, 8, 16, 64, 512, 4096};
  const std::size_t length = std::min(lengths[chance.below(std::size(lengths))], bytes.size());
  const std::size_t to = chance.below(bytes.size() - length + 1);
  switch (chance.below(5)) {
    case 0:
    case 1:
      for (std::size_t k = chance.below(4) + 1; k > 0; --k)
        bytes[chance.below(bytes.size())] ^= static_cast<char>(1 << chance.below(8));
      break;
    case 2: {
      const std::size_t kind = chance.below(3);
      const auto value = static_cast<char>(kind == 0 ? 0 : kind == 1 ? 0xff : chance.below(256));
      bytes.replace(to, length, std::string(length, value));
      break;
    }
    case 3:
      bytes.replace(to, length, bytes.substr(chance.below(bytes.size() - length + 1), length));
      break;
    default:
      bytes.resize(to);
  }
  return bytes;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// All numbers and texts of an archive as the library of HDF5 reads them.
herr_t add_dataset(hid_t file, const char* name, const H5O_info_t* info, void* data) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(dataset),
              space = H5Dget_space(dataset);
  const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  std::string bytes(count * H5Tget_size(type), '\0');
  if (count > 0) H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
  auto& all = *static_cast<std::map<std::string, std::string>*>(data);
  if (H5Tis_variable_str(type) > 0) {
    std::string& texts = all[name];
    for (std::size_t i = 0; i < count; ++i) {
      char* text = nullptr;
      std::copy_n(bytes.data() + i * sizeof text, sizeof text, reinterpret_cast<char*>(&text));
      texts.append(text ? text : "").push_back('\0');
      H5free_memory(text);
    }
  } else {
    all[name] = bytes;
  }
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(dataset);
  return 0;
}

std::string contents_of(const std::string& path) {
  std::map<std::string, std::string> all;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return "not open";
  const bool whole =
      H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, add_dataset, &all, H5O_INFO_BASIC) >= 0;
  H5Fclose(file);
  std::string text = whole ? "" : "not whole";
  for (const auto& [name, bytes] : all) text.append(name).append(1, '\0').append(bytes);
  return text;
}

template <class Result>
std::string read_an_ensemble(const std::string& file) {
  const Stored<Result> stored = read_ensemble<Result>(file);
  check_stored(stored, system_of(stored).system);
  if (stored.file == file) read_trajectories(file);
  return contents_of(stored.file);
}

/// Reads what there is under this name as the program does, and returns all that it holds.
std::string read_all(const std::string& file) {
  if (files::has_sweep(file)) {
    const files::SweepPlan plan = files::read_sweep(file).plan;
    files::check_parts(file, plan);
    std::string text;
    for (const std::string& system : plan.systems) text += system;
    return text;
  }
  const std::string kind = has_checkpoint(file) ? kind_of_ensemble(file) : kind_of_archive(file);
  std::string text;
  if (for_kind(kind, [&](auto result) {
        text = read_an_ensemble<typename decltype(result)::type>(file);
      }))
    return text;
  if (kind == "run") {
    read_run(file);
    read_hits(file);
    read_samples(file);
    read_starts(file);
    read_energies(file);
  } else if (kind == "section") {
    read_section(file);
  } else if (kind == "certified") {
    read_certified(file);
  } else if (kind == "compare") {
    read_comparison(file);
  } else if (kind == "orbit") {
    read_orbits(file);
  } else if (kind == "relax") {
    read_equilibria(file);
  } else if (kind == "sweep") {
    const files::StoredSweep stored = files::read_sweep(file);
    for (const std::size_t i : stored.computed)
      files::extract_value(files::value_of_sweep(file, i), file + "-value");
  } else {
    throw InputError(Place{file, 0, 0, ""}, "an archive of the kind '" + kind + "'");
  }
  return contents_of(file);
}

struct Source {
  std::string name, file, expected;  // FOLDER/NAME, its archive, what it holds
  std::vector<fs::path> parts;       // the files that may be damaged
  std::vector<std::string> bytes;    // of these
};

Source source_of(const fs::path& folder) {
  Source source{folder.filename().string(), (folder / "a.h5").string(), "", {}, {}};
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const bool own = entry.path().filename() == "carom.lock";
    if (!entry.is_regular_file() || own || entry.file_size() == 0) continue;
    source.parts.push_back(entry.path());
  }
  std::sort(source.parts.begin(), source.parts.end());
  for (const fs::path& part : source.parts) source.bytes.push_back(bytes_of(part));
  source.expected = read_all(source.file);
  return source;
}

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

int archives(const std::string& folder, std::uint64_t seed, std::uint64_t first,
             std::uint64_t count, bool only_names) {
  prepare_archives();
  std::vector<Source> sources;
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_directory()) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  for (const fs::path& one : folders) sources.push_back(source_of(one));
  for (std::uint64_t index = first; index < first + count; ++index) {
    Chance chance(seed * 0x9e3779b97f4a7c15u + index);
    const Source& source = sources[index % sources.size()];
    const std::size_t part = chance.below(source.parts.size());
    const std::string bad = damaged(source.bytes[part], chance);
    if (only_names) {
      std::cout << index << ' ' << source.name << ' ' << source.parts[part] << std::endl;
      continue;
    }
    write(source.parts[part], bad);
    judge(index, [&]() -> std::string {
      try {
        const bool same = read_all(source.file) == source.expected;
        return same ? "read" : "changed " + source.name;
      } catch (const InputError& error) {
        if (bad == source.bytes[part]) return "changed refused what was written";
        const bool named = std::string(error.what()).find(source.file) != std::string::npos;
        return named ? "refused" : "place " + source.name + ": " + first_line(error.what());
      }
    });
    write(source.parts[part], source.bytes[part]);
  }
  return 0;
}

}  // namespace
}  // namespace carom

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 1 && words[0] == "systems") return carom::systems();
  if (words.size() == 5 && (words[0] == "archives" || words[0] == "names"))
    return carom::archives(words[1], std::stoull(words[2]), std::stoull(words[3]),
                           std::stoull(words[4]), words[0] == "names");
  std::cerr << "readers systems | readers archives|names FOLDER SEED FROM COUNT\n";
  return 2;
}
