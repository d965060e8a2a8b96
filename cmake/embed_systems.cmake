# Writes the TOML files in SYSTEMS as raw strings into OUTPUT.
set(text "// Made from validation/systems by cmake/embed_systems.cmake.\n#include \"carom/files/system_file.hpp\"\n\nnamespace carom {\n\nconst std::vector<BuiltinSystem>& builtin_systems() {\n  static const std::vector<BuiltinSystem> systems{\n")
foreach(file IN LISTS SYSTEMS)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} content)
  string(APPEND text "      {\"${name}\", R\"TOML(${content})TOML\"},\n")
endforeach()
string(APPEND text "  };\n  return systems;\n}\n\n}  // namespace carom\n")
file(WRITE ${OUTPUT} "${text}")
