// What may be typed where --help shows a word such as FILE.h5 or SYSTEM.
#pragma once

#include <string>
#include <vector>

namespace carom::cli::manual {

struct Candidates {
  std::vector<std::string> words = {};
  bool systems = false;                   ///< names of built-in systems
  bool files = false;                     ///< names of files and folders
  std::vector<std::string> endings = {};  ///< of files that are meant, without the dot; none: all
};

/// `shown`: the word for the value of an option or for an argument. Numbers, points and the like
/// have no candidates.
Candidates candidates_of(const std::string& shown);
/// The names of the built-in systems.
std::vector<std::string> system_names();

}  // namespace carom::cli::manual
