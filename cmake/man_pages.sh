#!/bin/sh
# The man pages carom.1 and carom-COMMAND.1: what --help prints, set by help2man.
#   cmake/man_pages.sh HELP2MAN CAROM VERSION FOLDER
set -eu
help2man=$1 carom=$2 version=$3 folder=$4
sections=$(dirname "$0")/man_sections
rm -rf "$folder"
mkdir -p "$folder/work"

# A page of what `carom COMMAND --help` prints.
page() {
  name=carom${1:+-$1}
  # help2man wants a program of the page's name, and a blank between the names of an option.
  printf '#!/bin/sh\n"%s" %s --help | sed "s/^  -\\(.\\),--/  -\\1, --/"\n' "$carom" "$1" >"$folder/work/$name"
  chmod +x "$folder/work/$name"
  "$help2man" --no-info --locale=C.UTF-8 --name="$2" --source="carom $version" --version-string="$version" \
    --include="$sections" "$folder/work/$name" |
    sed '/^\.IP$/,/^\.PP$/{s/^\.IP$/&\n.nf/;s/^\.PP$/.fi\n&/;}' >"$folder/$name.1" # a line for each example
}

tab=$(printf '\t')
page "" "classical particles in two dimensions"
"$carom" --complete "carom " | while IFS=$tab read -r command text; do
  [ "$command" = help ] || page "$command" "$text"
done
rm -r "$folder/work"
