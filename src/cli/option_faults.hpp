// What is wrong with a command line that CLI11 has refused, in words.
#pragma once

#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace carom::cli {

/// Of the program's own words: no such command; "" if there is nothing to say.
std::string unknown_word(const CLI::App& app);
/// The first word that was typed and is not known, as a message. CLI11 tells them in another order.
std::string unknown_option(const CLI::App& app, const CLI::App& command, int argc, char** argv);
/// Two numbers of one option, typed with a blank between them: what to write instead; "" if there
/// are none.
std::string parted_pair(int argc, char** argv);

}  // namespace carom::cli
