#!/usr/bin/env bash
# Checks that a study, and the pictures of a recording, shared by GNU parallel with one worker
# killed and then completed by a second pass, give the files of a single run. Exits with 77
# (skipped) without GNU parallel.
#
#   cluster_test.sh SUNDER ROOT
set -euo pipefail
sunder=$1 root=$2
case $(parallel --version 2>/dev/null) in
  "GNU parallel"*) ;;
  *) echo "GNU parallel is missing: apt-get install parallel"; exit 77 ;;
esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "FAILED: $*"; exit 1; }

# Runs the program. The worker that has $DOOMED among its arguments is killed once, together with
# the script `worker`, as soon as a file $SIGN exists.
cat >worker <<'END'
#!/usr/bin/env bash
case " $* " in *" $DOOMED "*) ;; *) exec "$PROGRAM" "$@" ;; esac
[ ! -e killed ] || exec "$PROGRAM" "$@"
"$PROGRAM" "$@" &
until compgen -G "$SIGN" >/dev/null; do sleep 0.01; done
touch killed
kill -9 $! $$
END
chmod +x worker
export PROGRAM=$sunder SUNDER=$work/worker PARALLEL="--jobs 2"

# Share 2 of 4 has the runs 2 and 6 of 6; its worker is killed after the first.
printf 'draft draft\nrealtime realtime\nlimit draft accuracy.substeps=16\n' >points
study=("$root/bench/trade/scenes/pile.toml" --points points --seeds 2 --frames 60)
shared=("$root/bench/cluster/parallel_trade.sh" 4 "${study[@]}" -o shared)
"$sunder" trade "${study[@]}" -o whole --quiet
[ "$(find whole/runs -type f | wc -l)" -eq 6 ] || fail "not six runs"
export DOOMED=2/4 SIGN='shared/runs/pile/realtime-1.json'
! "${shared[@]}" 2>first || fail "the first pass has nothing missing"
[ -e killed ] || fail "no worker was killed"
[ "$(grep missing: first)" = "missing: pile/limit-2" ] || fail "the missing runs are: $(cat first)"
"${shared[@]}" || fail "the second pass"
diff -r whole/runs shared/runs || fail "other results than those of one run"

# Seven frames in ranges of two; the worker of the second range is killed after its first frame.
rm killed
"$sunder" simulate stack --frames 6 --take x.take --quiet
"$sunder" render x.take -o whole.png/ --size 64x48 --quiet
pictures=("$root/bench/cluster/parallel_render.sh" 7 2 x.take pictures --size 64x48)
export DOOMED=2:3 SIGN='pictures/frame_00002.png'
! "${pictures[@]}" || fail "the first pass lost no picture"
[ -e killed ] || fail "no worker was killed"
"${pictures[@]}" || fail "the second pass of pictures"
diff -r whole.png pictures || fail "other pictures than those of one run"
[ "$(find pictures -name '*.png' | wc -l)" -eq 7 ] || fail "not seven pictures"
echo "the same files"
