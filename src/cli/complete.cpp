
#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

#include "carom/files/system_file.hpp"
#include "cli/command_table.hpp"

namespace carom::cli {

namespace {

class Completions {
 public:
  explicit Completions(const std::string& begin) : begin_(begin) {}

  void word(std::string_view word, std::string_view meaning = "") {
    if (word.starts_with(begin_)) text_.append(word).append("\t").append(meaning).append("\n");
  }
  void commands(const std::vector<CommandRow>& table) {
    for (const CommandRow& command : table)
      if (!command.name.empty()) word(command.name, command.text);
    word("help", "Explain a command");
  }
  void options(const CommandRow& command) {
    for (const OptionRow& option : command.options)
      for (const std::string& name : option.names) word(name, option.help);
  }
  /// What may be typed where --help shows `shown`: nothing for numbers, points and the like.
  void value(const std::string& shown) {
    if (shown == "SYSTEM" || shown == "SOURCE" || shown == "NAME")
      for (const BuiltinSystem& system : builtin_systems()) word(system.name);
    if (shown.starts_with("KEY="))
      for (const KeyDescription& key : key_table()) word(key_of(key) + "=", key.meaning);
    if (shown == "SYSTEM") files("*.toml");
    if (shown == "SOURCE") files("*.toml *.h5 *.hdf5");
    if (shown == "FILES" || shown == "FILE.h5") files("*.h5 *.hdf5");
    if (shown == "FILE.svg") files("*.svg");
    if (shown == "PICTURE") files("*.png *.svg *.pdf");
    if (shown == "FILM") files("*.gif *.mp4");
    if (shown == "FILE") files("*");
    // "auto|events|steps" names its words; capitals are only described.
    if (shown.find('|') == std::string::npos ||
        std::any_of(shown.begin(), shown.end(), [](char c) { return c >= 'A' && c <= 'Z'; }))
      return;
    std::istringstream words(shown);
    for (std::string one; std::getline(words, one, '|');) word(one);
  }
  const std::string& text() const { return text_; }

 private:
  static std::string key_of(const KeyDescription& key) {
    std::string path(key.section);
    for (std::string_view list :
         {"table.obstacle", "table.hole", "table.wall", "table.loop", "injection", "potential"})
      if (path.starts_with(list)) path.insert(list.size(), "[0]");
    return path + (path.empty() ? "" : ".") + std::string(key.key);
  }
  void files(std::string_view patterns) { text_.append(patterns).append("\n"); }

  std::string begin_, text_;
};

const OptionRow* valued_option(const CommandRow& command, const std::string& name) {
  for (const OptionRow& option : command.options)
    if (!option.value.empty() && std::count(option.names.begin(), option.names.end(), name) > 0)
      return &option;
  return nullptr;
}

}  // namespace

std::string completions(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream text(line);
  for (std::string word; text >> word;) words.push_back(word);
  std::string begin;
  if (!line.empty() && line.back() != ' ' && !words.empty()) {
    begin = words.back();
    words.pop_back();
  }
  const std::vector<CommandRow> table = command_table();
  const auto is_option = [](const std::string& word) { return word.starts_with('-'); };
  const auto named = std::find_if_not(words.begin() + !words.empty(), words.end(), is_option);
  const std::string name = named == words.end() ? "" : *named;
  const auto command = std::find_if(table.begin(), table.end(),
                                    [&](const CommandRow& row) { return row.name == name; });
  if (name == "help" || name.empty()) {
    Completions found(begin);
    is_option(begin) ? found.options(table.front()) : found.commands(table);
    return found.text();
  }
  if (command == table.end()) return {};

  const OptionRow* open = nullptr;  // whose value comes next
  std::size_t given = 0;
  for (auto word = named + 1; word != words.end(); ++word) {
    if (open != nullptr) {
      open = nullptr;
    } else if (is_option(*word)) {
      open = valued_option(*command, *word);
    } else {
      ++given;
    }
  }
  const std::size_t equals = begin.find('=');
  if (open == nullptr && is_option(begin) && equals != std::string::npos) {
    open = valued_option(*command, begin.substr(0, equals));
    begin.erase(0, equals + 1);
  }
  Completions found(begin);
  if (begin.find_first_of("=:") != std::string::npos) return {};  // within KEY=VALUE or A:B
  if (open != nullptr) {
    found.value(open->value);
  } else if (is_option(begin) || (given >= command->arguments.size() && !command->many_arguments)) {
    found.options(*command);
  } else {
    found.value(command->arguments.back().names.front());
  }
  return found.text();
}

}  // namespace carom::cli
