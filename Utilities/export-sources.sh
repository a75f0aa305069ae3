# SPDX-License-Identifier: BSD-3-Clause
# Sourced. `export_sources`: the project's files, those that are not committed yet included, as a tar
# file on the standard output. Run it in the project's folder, which need not be a clone.

export_sources() {
  if git rev-parse --is-inside-work-tree > /dev/null 2>&1; then
    git ls-files -z --cached --others --exclude-standard |
      while IFS= read -r -d '' file; do if [ -e "$file" ]; then printf '%s\0' "$file"; fi; done
  else
    find . -path ./build -prune -o -type f -print0
  fi | tar --create --null --files-from=-
}
