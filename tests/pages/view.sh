#!/usr/bin/env bash
# Opens pages of `lilytank view` in headless Chromium at two widths. Compares every pose of the page with the run's
# trajectory.csv, presses controls, and fails on console errors, overflow, and names that became elements.
#   view.sh LILYTANK SOURCES       ends with 77 (skipped) where Chromium is not installed
set -euo pipefail
lilytank=$(realpath "$1") sources=$(realpath "$2")
source "$(dirname "${BASH_SOURCE[0]}")/chromium.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
faults=0

# title_of <page> <virtual milliseconds>: its title, which scripts have set.
title_of() {
  dump "$1" "$2" |
    sed -n 's/.*<title>\([^<]*\)<.title>.*/\1/p'
}

# frame <page> <width> <run, or nothing>: a page with the other one in a frame of that width, and the checks.
frame() {
  echo '<!doctype html><meta charset="utf-8"><title>unfinished</title><body><script>'
  printf 'const page=atob("%s"),width=%s;\n' "$(base64 -w0 "$1")" "$2"
  printf 'const rows=atob("%s").trim().split("\\n").slice(1).map(r=>r.split(","));\n' \
    "$([[ -z $3 ]] || base64 -w0 "$3/trajectory.csv")"
  printf 'const events=atob("%s").trim().split("\\n").slice(1).map(r=>r.split(","));\n' \
    "$([[ -z $3 ]] || base64 -w0 "$3/events.csv")"
  cat << 'JS'
// Virtual time does not wait for frames or for unpacking: frames come by a timer, and many timers fill the time.
setInterval(()=>{},1);
const catching='<script>window.faults=[];requestAnimationFrame=f=>setTimeout(()=>f(performance.now()),16);console.error=(...a)=>faults.push(a.join(" "));'+
  'addEventListener("error",e=>faults.push(e.message));'+
  'addEventListener("unhandledrejection",e=>faults.push(e.reason))<\/script>';
const f=document.createElement('iframe'),seen=[];
f.style=`width:${width}px;height:844px;border:0`;
const check=(name,right)=>{ if(!right) seen.push(name); };
const turn=2*Math.PI,degree=turn/360;
const drawn=w=>new Promise(done=>w.requestAnimationFrame(()=>w.requestAnimationFrame(done)));

function comparePoses(w) {
  let place=0,heading=0,states=0;
  for(const [,time,id,x,y,theta,label,last] of rows) {
    const p=w.lilytank.poseAt(+time,+id);
    place=Math.max(place,Math.abs(p.x-x),Math.abs(p.y-y));
    heading=Math.max(heading,Math.abs(((p.theta-theta)%turn+1.5*turn)%turn-turn/2));
    states+=p.label!==+label||p.last!==+(last||-1);
  }
  check(`places ${place}`,place<=0.5e-4+1e-7),check(`headings ${heading}`,heading<=0.05*degree+1e-6);
  check(`states ${states}`,states===0);
  return ` place ${(1e3*place).toFixed(4)} mm heading ${(heading/degree).toFixed(4)} degrees`;
}

// Labels change at the time of an event, not at the next stored frame.
function compareEvents(w) {
  const between=(module,from,to)=>events.filter(e=>[e[3],e[5]].includes(module)&&e[0]>from&&e[0]<=to).length;
  const next=t=>w.lilytank.tanks[0].time.find(frame=>frame>t)??t;
  let compared=0;
  for(const [time,,kind,a,,b,,,label_a,,label_b] of events) for(const [module,label] of [[a,label_a],[b,label_b]]) {
    if(!/link/.test(kind)||between(module,+time,next(+time)+1e-9)) continue;
    ++compared,check(`label of ${module} at ${time} s`,w.lilytank.poseAt(+time,+module).label===+label);
  }
  check('events of labels',compared>10);
}

async function pressControls(w,d) {
  const key=k=>d.body.dispatchEvent(new w.KeyboardEvent('keydown',{key:k,bubbles:true}));
  const slider=d.getElementById('scrub'),tank=w.lilytank.tanks[0];
  slider.value=20.3,slider.dispatchEvent(new w.Event('input')),await drawn(w);
  check('slider',Math.abs(w.lilytank.time-20.3)<1e-9);
  key('ArrowRight'),await drawn(w);
  const next=tank.time.find(t=>t>20.3+1e-9);
  check('right',w.lilytank.time===next);
  key('Home'),check('home',w.lilytank.time===0),key('End'),check('end',w.lilytank.time===tank.end);
  key('Home'),key(' '),check('play',d.body.classList.contains('playing'));
  await drawn(w),await drawn(w),check('plays',w.lilytank.time>0),key(' ');
  check('pause',!d.body.classList.contains('playing'));
  key('f'),await drawn(w),check('follow',d.getElementById('follow').getAttribute('aria-pressed')==='true');
  check('module',/Module 0/.test(d.getElementById('module').textContent));
  key('0'),await drawn(w);
  const canvas=d.querySelector('figure canvas'),box=canvas.getBoundingClientRect();
  const p=w.lilytank.poseAt(w.lilytank.time,3),scale=Math.min(box.width,box.height)/(2.12*tank.radius);
  canvas.dispatchEvent(new w.PointerEvent('pointermove',{bubbles:true,pointerId:1,pointerType:'mouse',
    clientX:box.left+box.width/2+p.x*scale,clientY:box.top+box.height/2-p.y*scale}));
  await drawn(w);
  const tip=d.getElementById('tip');
  check('tip '+tip.textContent,!tip.hidden&&/Module 3.*state.*faces.*position.*heading/.test(tip.textContent));
}

async function clickEvents(w,d) {
  const shown=[...d.querySelectorAll('#rows button')].filter(b=>!b.hidden);
  check('events',shown.length>2);
  for(const row of [shown[2],shown[0],shown.at(-1)]) {
    const i=+row.value;
    row.click(),await drawn(w);
    check(`event ${i} at ${events[i][0]} s: ${w.lilytank.time}`,Math.abs(w.lilytank.time-events[i][0])<2e-5);
  }
}

f.onload=async()=>{
  const w=f.contentWindow,d=f.contentDocument;
  let text='';
  try {
    await w.lilytank.ready,await drawn(w);
    check('over '+(d.documentElement.scrollWidth-width),d.documentElement.scrollWidth<=width);
    check('name',!rows.length||d.getElementById('title').textContent.includes('<b>"&'));
    check('elements',d.querySelectorAll('img,h1 *,b b,iframe').length===0);
    check('labels',[...d.querySelectorAll('canvas')].every(c=>c.getAttribute('aria-label'))&&
      [...d.querySelectorAll('button')].every(b=>b.textContent.trim()||b.getAttribute('aria-label')));
    check('outside',d.querySelectorAll('[src],[href]').length===0);
    const pixels=d.querySelector('figure canvas').getContext('2d').getImageData(0,0,w.innerWidth/2,300).data;
    check('drawn',pixels.some(v=>v>0));
    if(rows.length) text=comparePoses(w),compareEvents(w),await clickEvents(w,d),await pressControls(w,d);
    check('over at the end',d.documentElement.scrollWidth<=width);
    seen.push(...w.faults);
  } catch(problem) { seen.push(problem.message); }
  document.title='faults '+seen.length+' '+seen.join('; ')+text;
};
f.srcdoc=new TextDecoder().decode(Uint8Array.from(page,c=>c.charCodeAt(0))).replace('<head>','<head>'+catching);
document.body.append(f);
JS
  echo '</script>'
}

# look <name> <page> [run]
look() {
  local width seen wait
  for width in 390 1280; do
    frame "$2" "$width" "${3:-}" > "$work/frame.html"
    for wait in 10000 60000; do
      seen=$(title_of "$work/frame.html" "$wait")
      [[ $seen == faults* ]] && break
    done
    printf '%-10s %5s px  %s\n' "$1" "$width" "$seen"
    [[ $seen == 'faults 0 '* ]] || faults=$((faults + 1))
  done
}

cd "$work"
hostile='<b>"&<img src=x onerror=alert(1)>'
run() {
  "$lilytank" run "$sources/scenarios/demo.toml" --set run.duration='40 s' --set output.rate=5 \
    --set output.trajectory='"csv"' --quiet --out "$@" > /dev/null 2>&1
}
run "a$hostile"
"$lilytank" view "a$hostile" --quiet > /dev/null
look run "a$hostile/view.html" "a$hostile"

run "b$hostile" --seed 2
"$lilytank" view "a$hostile" "b$hostile" --out both.html --quiet > /dev/null
look runs both.html "a$hostile"

printf '[study]\nname = "chains"\nscenario = "%s"\nreplicates = 2\n[[axis]]\npath = "module.count"\nvalues = [5, 6]\n' \
  "$sources/scenarios/demo.toml" > study.toml
"$lilytank" study study.toml --set run.duration='2 min' --quiet --out study > /dev/null 2>&1
"$lilytank" view study study.toml --out "c$hostile.html" --quiet > /dev/null
look study "c$hostile.html"

mkdir diagnosis
cat > diagnosis/diagnosis.json << 'JSON'
{"name": "tank", "verdict": "missing", "findings": [{"effect": "<b>pair_repulsion"}],
 "parameters": [{"path": "flow.K_v", "alone": 1.1}]}
JSON
echo 'forces.pair_repulsion.strength = 0.005' > diagnosis/missing.toml
"$lilytank" view diagnosis "$sources/scenarios/experiments/tank.toml" --quiet > /dev/null
look diagnosis diagnosis/view.html

((faults == 0)) || echo "$faults pages are not as they should be"
exit $((faults > 0))
