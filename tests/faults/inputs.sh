# The inputs of the commands that faults are injected into.
make_inputs() {
  mkdir "$in"
  cp "$here/../support/pair.rules" "$in/"
  cat > "$in/tank.toml" <<'END'
title = "pair"
[run]
duration = 100
[tank]
radius = 0.16
[module]
count = 6
[start]
radius = 0.12
[ruleset]
file = "pair.rules"
END
  grep -v -e ruleset -e pair.rules "$in/tank.toml" > "$in/bare.toml"
  cat > "$in/pairs.toml" <<'END'
[study]
name = "pairs"
scenario = "tank.toml"
replicates = 3
[[axis]]
path = "rules.part.p"
values = [0, 0.5]
END
  sed 's/"pairs"/"others"/; s/0.5/0.25/' "$in/pairs.toml" > "$in/others.toml"
  cat > "$in/best.toml" <<'END'
[optimize]
name = "best"
scenario = ["tank.toml"]
fitness = "full_yield_time"
evaluations = 20
final_evaluations = 6
[[parameter]]
path = "rules.part.p"
low = 1e-3
high = 1
scale = "log"
END
  printf 'name cross5\n.#.\n###\n.#.\n' > "$in/cross.txt"
  printf 'name bar4\n####\n' > "$in/bar.txt"
  printf 'id,x,y,theta\n0,0.05,0,0\n1,-0.05,0.02,1.5\n' > "$in/start.csv"
  awk 'BEGIN { print "frame,time,id,x,y,theta"
               for (f = 0; f < 60; f++)
                 for (b = 0; b < 2; b++)
                   printf "%d,%.6f,%d,%.6f,%.6f,0.1\n", f, f / 30, b, 0.05 * b + 0.0005 * f, 0.01 }' \
    > "$in/tracks.csv"
  cat > "$in/flow.csv" <<'END'
ix,iy,x_m,y_m,mean_vx_mps,mean_vy_mps,std_vx_mps,std_vy_mps,measured
0,0,-0.1,-0.1,0.01,0,0.001,0.002,1
1,0,0.1,-0.1,0.01,0.02,0.001,0.002,1
0,1,-0.1,0.1,0.01,-0.01,0,0.002,1
1,1,0.1,0.1,0,0,0,0,0
END
  printf 'base = "tank.toml"\n[experiment]\nname = "two"\n[[recording]]\nfile = "tracks.csv"\n' \
    > "$in/experiment.toml"
  "$lily" run "$in/tank.toml" --quiet --set run.duration=8 --out "$in/done" > /dev/null 2>&1
}
