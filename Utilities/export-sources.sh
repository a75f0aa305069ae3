# SPDX-License-Identifier: BSD-3-Clause
# Sourced. export_sources writes the project's files, those that are not committed yet too, as a tar
# file to the standard output. It runs in the project's folder, which need not be a clone.

export_sources() {
  if [ -e .git ]; then # not where an archive lies within a clone
    git ls-files -z --cached --others --exclude-standard |
      while IFS= read -r -d '' file; do if [ -e "$file" ]; then printf '%s\0' "$file"; fi; done
  else
    find . -path ./build -prune -o -type f -print0
  fi | tar --create --null --files-from=-
}
