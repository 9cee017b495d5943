# The steps of the Containerfile in a bare root, for machines without containers; sourced by
# tools/bare_machine_test.sh, needs repository and bare.

# The instructions, one per line, without comments and continued lines.
instructions() { sed -E '/^#|^$/d' "$1" | sed -E ':a; /\\$/N; s/\\\n//; ta'; }

# It knows the instructions that the file has, and no other. SETS chooses the sets, as --build-arg.
run_container_steps() {
  local instruction rest user=root folder=/ entry=() command=()
  while read -r -u 3 instruction rest; do
    echo "== $instruction $rest"
    case $instruction in
      ARG | FROM | ENV) ;;
      COPY) clone_into "${rest#. }" ;;
      WORKDIR) folder=$rest ;;
      USER) user=$rest ;;
      RUN) inside "$user" env "SETS=${SETS:-base}" sh -ec "cd '$folder'; $rest" ;;
      ENTRYPOINT) mapfile -t entry < <(list "$rest") ;;
      CMD) mapfile -t command < <(list "$rest") ;;
      *)
        echo "tools/bare_machine/container.bash does not know $instruction" >&2
        return 1
        ;;
    esac
  done 3< <(instructions "$repository/Containerfile")
  echo "== as $user: ${entry[*]} ${command[*]}"
  AROUND=("${ALONE[@]}")  # the port of its ROS master is free there
  # shellcheck disable=SC2154
  inside "$user" sh -c "cd '$folder' && exec timeout --signal INT 60 \"\$@\"" sh "${entry[@]}" \
    "${command[@]}" 2>&1 | tee "$bare.output" || true  # timeout ends it
  grep -q 'Successfully spawned' "$bare.output"
}

list() { python3 -c 'import json, sys; print(*json.loads(sys.argv[1]), sep="\n")' "$1"; }
