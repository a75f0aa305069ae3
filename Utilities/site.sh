#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: site.sh [--no-api]
Builds the documentation as a static site with search into build/site: the pages by MkDocs, the
reference of the classes by Doxygen. Open build/site/index.html, or copy the folder to any server:
only there the search works, as after python3 -m http.server --directory build/site.
Fails, and names page and link, where a page, a heading or a picture that a page links to is
missing. Links to other sites are not followed.
Needs the Debian packages mkdocs and doxygen (install-packages.sh --site).
  --no-api   without the reference of the classes
END
}

api=yes
for option in "$@"; do
  case "$option" in
    -h | --help) usage; exit 0 ;;
    --no-api) api=no ;;
    *) usage >&2; exit 2 ;;
  esac
done
if ! command -v mkdocs > /dev/null; then
  echo "site.sh: mkdocs is missing; Utilities/install-packages.sh --site installs it." >&2
  exit 1
fi

# The pages lie in one folder as they lie in the project, so that their links hold. Sources that
# they link to are part of the site.
staging=build/site-staging
rm -rf "$staging" build/site
mkdir -p "$staging/pages"
cp --parents README.md CONTRIBUTING.md CHANGELOG.md CITATION.cff LICENSE Filters/layers.txt \
  "$staging/pages"
find Documentation Examples -type f ! -name '*.in' ! -name '*.yml' ! -name '*.sed' \
  -exec cp --parents -t "$staging/pages" {} +
cp Documentation/mkdocs.yml "$staging"
python3 cmake/properties.py pages "$staging/pages/Documentation/Properties"
{
  echo "  - Properties:"
  for page in "$staging"/pages/Documentation/Properties/*.md; do
    echo "      - $(sed -n '1s/^# //p' "$page"): Documentation/Properties/$(basename "$page")"
  done
} >> "$staging/mkdocs.yml"
if [ "$api" = yes ]; then
  Utilities/check-documentation.sh
  cp -r build/documentation/html "$staging/pages/api"
else
  sed -i '/api\/index.html/d' "$staging/mkdocs.yml"
fi
mkdocs build --quiet --strict --config-file "$staging/mkdocs.yml"
mv "$staging/site" build/site
rm -rf "$staging"
python3 Utilities/site_links.py build/site
echo "The site: $PWD/build/site/index.html"
