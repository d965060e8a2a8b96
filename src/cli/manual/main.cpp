// carom_manual FOLDER writes the man page and the completions of the shells into FOLDER.
#include <fstream>
#include <iostream>
#include <string>
#include <utility>

#include "cli/manual/manual.hpp"

int main(int argc, char** argv) {
  using namespace carom::cli;
  if (argc != 2) {
    std::cerr << "carom_manual FOLDER\n";
    return 2;
  }
  const std::vector<CommandRow> table = command_table();
  const std::pair<const char*, std::string> texts[] = {{"carom.1", manual::man_page(table)},
                                                       {"carom", manual::bash_completion(table)},
                                                       {"_carom", manual::zsh_completion(table)}};
  for (const auto& [name, text] : texts) {
    std::ofstream file(std::string(argv[1]) + "/" + name);
    file << text;
    if (!file.flush()) {
      std::cerr << "carom_manual: cannot write " << argv[1] << "/" << name << "\n";
      return 1;
    }
  }
  return 0;
}
