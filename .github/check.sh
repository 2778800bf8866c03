#!/usr/bin/env bash
# Checks the files for the forge with linters, the versions of all packages, and the licences of the
# code of others.
# Installs `check-jsonschema` and `yamllint` into the given virtual environment.
set -euo pipefail
python=${1:?usage: .github/check.sh VENV/bin/python}
cd "$(dirname "$0")/.."
"$python" -m pip install --quiet --disable-pip-version-check 'check-jsonschema>=0.33' 'yamllint>=1.35'

schema() {
  echo "$1:" "${@:2}"
  "$python" -m check_jsonschema --default-filetype yaml --builtin-schema "$1" "${@:2}"
}
schema vendor.github-workflows .github/workflows/*.yml
schema vendor.github-actions .github/actions/*/action.yml
schema vendor.github-issue-config .github/ISSUE_TEMPLATE/config.yml
schema vendor.github-issue-forms .github/ISSUE_TEMPLATE/{bug,sensor-or-chip}.yml
schema vendor.citation-file-format CITATION.cff
"$python" -m yamllint --strict --config-file .github/yamllint.yml .github CITATION.cff
"$python" .github/check_versions.py
"$python" .github/licences.py
"$python" .github/licences.py --manifest-path web/engine/Cargo.toml
