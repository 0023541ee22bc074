"""Colours and sizes of the page, for light and dark.

The page does not use Tailwind.  In the browser, Tailwind checks each change of the page and writes its style sheet
again; with 20 updates a second, this takes most of a core.  Its class names that are used are defined here, with the
same meaning.
"""

from __future__ import annotations

from typing import Final

UTILITIES: Final = """
.w-full { width:100%; } .pr-3 { padding-right:12px; } .whitespace-pre-line { white-space:pre-line; }
.bg-transparent { background:transparent; } .p-1 { padding:4px; }
.items-center { align-items:center; } .items-start { align-items:flex-start; } .items-end { align-items:flex-end; }
.items-baseline { align-items:baseline; }
.no-wrap { flex-wrap:nowrap; } .gap-0 { gap:0; }
.gap-1 { gap:4px; } .gap-2 { gap:8px; } .gap-3 { gap:12px; } .gap-4 { gap:16px; }
.gap-x-2 { column-gap:8px; } .gap-x-3 { column-gap:12px; }
.gap-x-4 { column-gap:16px; } .gap-x-6 { column-gap:24px; } .gap-y-0 { row-gap:0; } .gap-y-1 { row-gap:4px; }
.w-20 { width:80px; } .w-24 { width:96px; } .w-28 { width:112px; } .w-32 { width:128px; } .w-36 { width:144px; }
.w-40 { width:160px; } .w-44 { width:176px; } .w-52 { width:208px; } .w-56 { width:224px; } .w-64 { width:256px; }
"""

#: Sets the chosen theme, or that of the system, before the first paint.  It also prevents that Space, the key of STOP,
#: presses the button that has the focus: here it only stops (Enter presses).
HEAD: Final = """<script>
  function hilShowLight() {
    let chosen = null;
    try { chosen = localStorage.getItem("hil-light"); } catch {}
    if (chosen) document.documentElement.dataset.light = chosen;
    else delete document.documentElement.dataset.light;
    return chosen;
  }
  function hilPaintLight() {
    const chosen = hilShowLight();
    document.querySelector(".q-loading-bar")?.setAttribute("aria-label", "loading");
    if (window.Quasar) Quasar.Dark.set(chosen ? chosen === "dark" : "auto");
    else setTimeout(hilPaintLight, 10);
  }
  function hilOtherLight() {
    const next = Quasar.Dark.isActive ? "light" : "dark";
    const systems = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
    try { next === systems ? localStorage.removeItem("hil-light") : localStorage.setItem("hil-light", next); } catch {}
    hilPaintLight();
  }
  // Whether there is room for a second set of panels: told as often as it becomes so, first when the page is alive.
  const hilWide = matchMedia("(min-width:1600px)");
  function hilTellWide() {
    if (!hilWide.matches) return;
    if (window.did_handshake) emitEvent("hil-wide");
    else setTimeout(hilTellWide, 50);
  }
  hilWide.addEventListener("change", hilTellWide);
  addEventListener("DOMContentLoaded", hilTellWide);
  hilShowLight();
  addEventListener("DOMContentLoaded", hilPaintLight);
  for (const name of ["keydown", "keyup"]) addEventListener(name, (e) => {
    if (e.key === " " && !e.target.closest?.("input:not([type=checkbox]),textarea,select")) e.preventDefault();
  }, true);
</script>"""

#: The colours by their meanings, for the light and the dark theme.
LIGHT: Final = """color-scheme:light;
  --ink:#17202b; --soft:#52606d; --paper:#ffffff; --panel:#f4f6f8; --line:#cfd6dd; --wall:#2f3944;
  --true:#08736e; --odo:#1d57b8; --cloud:#b93a0a; --beam:#b98500; --real:#6b21a8; --post:#7d8894; --loaded:#6d7a18;
  --run:#087443; --wait:#855300; --bad:#b42318; --mark:#fff3c4; --focus:#1d57b8;
  --line-0:#1d57b8; --line-1:#b93a0a; --line-2:#08736e; --line-3:#6b21a8; --line-4:#855300; --line-5:#b42318;
  --line-6:#5d6914; --line-7:#52606d;"""
DARK: Final = """color-scheme:dark;
  --ink:#e6ebf0; --soft:#a3b0bd; --paper:#12171d; --panel:#1b222a; --line:#36414c; --wall:#c3ccd5;
  --true:#3ecfc4; --odo:#7fb0ff; --cloud:#ff9a70; --beam:#f0c04a; --real:#c9a4f7; --post:#8b97a3; --loaded:#c7d66a;
  --run:#4bd28f; --wait:#f0b44a; --bad:#ff8a80; --mark:#4a3f12; --focus:#7fb0ff;
  --line-0:#7fb0ff; --line-1:#ff9a70; --line-2:#3ecfc4; --line-3:#c9a4f7; --line-4:#f0c04a; --line-5:#ff8a80;
  --line-6:#c7d66a; --line-7:#a3b0bd;"""
#: The number of colours for the lines of a chart: `var(--line-0)` and so on.
LINES: Final = 8

#: The style of words, tiles and source on every page.
WORDS: Final = """
.heard { position:absolute; width:1px; height:1px; overflow:hidden; clip-path:inset(50%); margin:0; }
.tile { border:1px solid var(--line); border-radius:6px; background:var(--panel); padding:2px 8px; min-width:60px;
  display:flex; flex-direction:column; align-items:flex-start; font:inherit; color:inherit; text-align:left; }
.tile .title { font-size:11px; color:var(--soft); line-height:1.2; } .tile .value { font-weight:600; line-height:1.3; }
.severity { font-weight:600; white-space:nowrap; } .severity.error { color:var(--bad); }
.severity.warning { color:var(--wait); } .severity.note { color:var(--odo); }
.severity.accepted { color:var(--soft); }
.soft { color:var(--soft); }
.head { font-weight:600; font-size:13px; }
.mono, .mono td, .mono th, .mono .nicegui-log, .mono div { font-family:ui-monospace,
  "DejaVu Sans Mono",Menlo,Consolas,monospace; font-size:12px; }
.value { font-variant-numeric:tabular-nums; white-space:pre; }
.chip { padding:2px 10px; border-radius:10px; font-weight:600; border:1px solid currentColor; }
.chip.run { color:var(--run); } .chip.wait { color:var(--wait); } .chip.bad { color:var(--bad); }
.key { display:inline-block; width:18px; height:0; border-top:3px solid; vertical-align:middle; margin-right:4px; }
.code { background:var(--paper); border:1px solid var(--line); border-radius:4px; padding:4px; overflow-x:auto; }
.code div { white-space:pre; } .code .here { background:var(--mark); font-weight:600; }
"""
#: The style of the arena, which `arena_drawing.py` draws.
ARENA: Final = """
.arena { background:var(--paper); border:1px solid var(--line); border-radius:6px; overflow:hidden; position:relative;
  flex:1 1 0; min-height:260px; }
.window { position:absolute; inset:0; touch-action:pan-y; cursor:grab; user-select:none; }
:is(.hand-add, .hand-remove) .window { cursor:crosshair; }
.hand-drag .grip { cursor:move; } .hand-remove .grip { cursor:pointer; }
/* Each layer is painted by itself: a robot that moves leaves the cloud alone.  Lines are as wide at any zoom. */
.window .layer { position:absolute; inset:0; width:100%; height:100%; will-change:transform; pointer-events:none; }
.window .layer * { vector-effect:non-scaling-stroke; }
.window text { font-size:calc(11px * var(--unit, 1)); }
.window .grip { pointer-events:auto; touch-action:none; fill:transparent; fill-opacity:0; stroke:none; }
.window .away path { fill:var(--odo); } .window .away text { fill:var(--ink); font-weight:600; }
.grid path { stroke:var(--line); stroke-width:1; fill:none; } .grid text { fill:var(--soft); }
.wall { stroke:var(--wall); stroke-width:4; stroke-linecap:round; fill:none; }
.post { fill:var(--post); stroke:var(--wall); stroke-width:2; }
.robot circle { fill:var(--true); fill-opacity:.25; stroke:var(--true); stroke-width:3; }
.robot path { stroke:var(--true); stroke-width:3.5; fill:none; stroke-linecap:round; }
.robot .pressed { stroke:var(--bad); stroke-width:7; }
.ghost circle { fill:none; stroke:var(--odo); stroke-width:2.5; stroke-dasharray:6 5; }
.ghost path { stroke:var(--odo); stroke-width:2.5; stroke-dasharray:6 5; fill:none; }
.beam { fill:var(--beam); fill-opacity:.14; stroke:none; } .measured { stroke:var(--beam); stroke-width:3; fill:none; }
.ray { stroke:var(--real); stroke-width:1.2; stroke-dasharray:3 4; fill:none; }
.hit { stroke:var(--real); stroke-width:2.5; fill:none; } .echo { stroke:var(--real); stroke-width:3; fill:none; }
.trail-true { stroke:var(--true); stroke-width:2.5; fill:none; }
.trail-odo { stroke:var(--odo); stroke-width:2; stroke-dasharray:7 4; fill:none; }
.cloud { stroke:var(--cloud); stroke-width:3.5; stroke-linecap:round; fill:none; }
"""

CSS: Final = (
    UTILITIES
    + f":root {{ {LIGHT} }}\n@media (prefers-color-scheme: dark) {{ :root {{ {DARK} }} }}\n"
    + f":root[data-light=light] {{ {LIGHT} }}\n:root[data-light=dark] {{ {DARK} }}\n"
    + WORDS
    + ARENA
    + """
html { background:var(--paper); }
/* Until the scripts are there. */
body:not(:has(.nicegui-content))::before { content:"c2000-hil: the page is loaded ..."; display:block; padding:12px; }
body { background:var(--paper); color:var(--ink); font-size:13px; }
.nicegui-content { padding:8px 12px; gap:8px; height:max(100vh, 600px); height:max(100dvh, 600px); width:100%;
  flex-wrap:nowrap; }
/* Quasar takes the outline away from all of its buttons and boxes, and nothing can bring it back: a ring of shadow. */
:focus-visible, .q-field:has(:focus-visible) { outline:none;
  box-shadow:0 0 0 2px var(--paper), 0 0 0 5px var(--focus) !important; border-radius:4px; }
.q-field :focus-visible { box-shadow:none !important; }
.unseen { display:none; } .narrow { display:none !important; }
.top { display:flex; align-items:center; gap:10px; width:100%; position:sticky; top:0; z-index:20;
  flex:none; background:var(--paper); padding:4px 0; }
.corner { margin-left:auto; flex:none; }
.tiles { display:flex; flex-wrap:wrap; gap:6px; min-width:0; flex:1 1 0; }
button.tile { cursor:pointer; }
.main { display:flex; gap:12px; width:100%; flex:1 1 0; min-height:0; align-items:stretch; }
.left { display:flex; flex-direction:column; gap:4px; flex:1 1 54%; min-width:0; }
.parts { flex:1 1 0; overflow-y:auto; flex-wrap:nowrap; } .parts .fills { flex:1 0 300px; flex-wrap:nowrap; }
.parts .panel { flex-shrink:0; }
.scrub .bar { position:relative; flex:1 1 0; min-width:0; padding:0 6px; }
.scrub svg { display:block; width:100%; height:17px; }
.scrub svg { cursor:pointer; } .scrub .reach { fill:transparent; } .scrub .known { fill:var(--post); }
.scrub .finding { fill:var(--odo); } .scrub .error { fill:var(--bad); } .scrub .warning { fill:var(--wait); }
.scrub .accepted { fill:var(--post); }
.scrub .order { fill:var(--run); } .scrub .hand { fill:var(--real); } .scrub .world { fill:var(--cloud); }
.console { display:flex; flex-direction:column; gap:8px; }
.stick { flex:none; width:170px; height:170px; touch-action:none; } .stick.off { opacity:.5; }
/* A panel scrolls: nothing in it becomes smaller but the log. */
.q-tab-panel > * { flex-shrink:0; }
.log { flex:1 1 200px; min-height:200px; }
.panel { background:var(--panel); border:1px solid var(--line); border-radius:6px; padding:8px; color:var(--ink); }
.q-uploader__list { display:none; }
.notice { color:var(--soft); white-space:pre-line; overflow-wrap:anywhere; } .notice.wrong { color:var(--bad); }
.one-line { flex:1 1 0; min-width:0; overflow:hidden; text-overflow:ellipsis; }
/* A table takes the panel's height, and makes room when the chosen row is explained below it. */
.scrolled:has(~ .detail:not(:empty), ~ .fields:not(.hidden)) { overflow:auto;
  max-height:clamp(130px, 32vh, 420px); }
.rows { width:100%; border-collapse:collapse; }
.rows th { position:sticky; top:0; z-index:1; background:var(--panel); text-align:left; font-weight:600; }
.rows th, .rows td { padding:3px 6px; font-size:12px; line-height:1.45; overflow-wrap:anywhere; vertical-align:top; }
.rows td { border-top:1px solid var(--line); } .rows.findings :is(td, th):last-child { white-space:nowrap; }
.rows tbody tr:has(button) { cursor:pointer; } .rows tbody tr:has(button):hover { background:var(--line); }
.registers .whole, .fields .whole, .moments .whole { white-space:nowrap; }
.rows .chosen { background:var(--mark); }
.moved { background:var(--mark); border-radius:3px; padding:0 3px; } .not-reset { font-weight:700; }
.link { all:unset; cursor:pointer; text-decoration:underline; text-decoration-color:var(--line); }
.side { flex:1 1 46%; min-width:0; display:flex; flex-direction:column; gap:4px; padding:4px; }
.side.console, .in-sight { flex:1 1 0; min-height:0; overflow-y:auto; overflow-x:hidden; }
.q-tab-panels .q-tab-panel { overflow:visible; }
.beside { display:none; }
@media (min-width:1600px) {
  .left { flex-basis:40%; } .side, .beside { flex-basis:30%; } .beside:has(.side) { display:flex; flex:1 1 30%;
  min-width:0; }
}
.q-btn--dense:not(.big) { padding:4px 8px; }
.unset .q-slider__thumb, .unset .q-slider__selection { opacity:.3; }
.big { font-size:17px; font-weight:700; min-width:150px; min-height:46px; }
.signals { max-height:260px; overflow:auto; border:1px solid var(--line); border-radius:4px; padding:4px;
  background:var(--paper); }
.signals .q-tree__node-header { padding:1px 4px; margin-top:0; } .signals .q-tree { color:var(--ink); width:100%; }
.reading { overflow-x:auto; } .reading table { border-collapse:collapse; font-variant-numeric:tabular-nums; }
.reading th, .reading td { padding:1px 12px 1px 0; text-align:left; font-size:12px; white-space:nowrap; }
.reading th div { font-weight:400; color:var(--soft); }
.nicegui-echart, .lanes { touch-action:pan-y; }
.lanes { position:relative; } .lanes svg { display:block; overflow:visible; }
.arena .tools { position:absolute; right:6px; top:6px; z-index:2; } .arena .hands { right:auto; left:6px; }
.arena .tools .q-btn, .arena .hands .q-field { background:var(--paper); min-width:28px; }
.arena .tools .q-btn { padding:2px 6px; min-height:28px; }
.held circle { fill:var(--wait); fill-opacity:.3; stroke:var(--wait); stroke-width:3; }
.held path { stroke:var(--wait); stroke-width:3; fill:none; }
.trail-loaded { stroke:var(--loaded); stroke-width:2; fill:none; }
.cloud-loaded { stroke:var(--loaded); stroke-width:4; stroke-linecap:round; fill:none; }
@media (min-width:761px) { .legend { font-size:12px; } }
.lanes text { fill:var(--ink); font-size:13px; } .lanes .axis { stroke:var(--line); }
.lanes .running { fill:var(--run); } .lanes .ready { fill:var(--wait); fill-opacity:.55; }
.lanes .waiting { fill:var(--bad); } .lanes .raised { stroke:var(--real); stroke-width:3; }
.lanes .many { fill-opacity:.4; }
.lanes .level { stroke:var(--odo); stroke-width:1.6; fill:none; } .lanes .level.many { fill:var(--odo); stroke:none; }
.lanes .bus { stroke:var(--true); stroke-width:1.3; fill:var(--paper); }
.lanes .busy { fill:var(--true); fill-opacity:.4; }
.lanes .word { font-family:ui-monospace,"DejaVu Sans Mono",Menlo,Consolas,monospace; font-size:11px; }
.lanes .small { fill:var(--soft); font-size:10px; } .lanes .time { fill:var(--soft); font-size:11px; }
.lanes .cursor { stroke:var(--ink); stroke-width:1.5; stroke-dasharray:4 3; }
.body--dark .q-btn--outline.text-primary, .body--dark .q-btn--flat.text-primary { --q-primary:#8ab8ff; }
.q-tab { min-height:34px; padding:0 10px; }
.q-field__label, .q-placeholder::placeholder { color:var(--soft) !important; }
@media (max-width:1200px) {
  .top { flex-wrap:wrap; } .tiles { order:3; flex-basis:100%; } .hint { display:none; }
  .q-tab { padding:0 7px; } .q-tab__label { font-size:13px; }
}
@media (max-width:1000px) {
  .q-tab { padding:0 4px; flex:1 1 auto; } .q-tab__label { font-size:12px; }
}
/* A phone in landscape: what is above the buttons scrolls away, they stay; below them arena and panel as high as it. */
@media (min-width:761px) and (max-height:500px) {
  .nicegui-content { height:auto; padding:4px 8px; gap:6px; } .tiles { order:-1; flex-basis:100%; flex-wrap:nowrap; }
  .top { flex-wrap:wrap; top:-46px; } .tile { flex:1 1 auto; min-width:46px; padding:1px 6px; font-size:12px; }
  .big { min-height:40px; min-width:120px; } .side .wide { display:none !important; }
  .main { flex:none; height:calc(100dvh - 56px); min-height:300px; } .arena { min-height:180px; }
}
@media (max-width:760px) {
  .nicegui-content { padding:4px 8px; gap:6px; height:auto; } .main { flex-direction:column; gap:6px; flex:none; }
  .top { position:static; display:contents; }
  .orders { position:sticky; top:0; z-index:20; width:100%; background:var(--paper); padding:4px 0; }
  .orders .big { flex:1 1 0; min-width:0; } .corner { position:absolute; right:8px; top:60px; }
  .tiles { order:0; width:100%; flex:none; gap:4px; }
  .tile { flex:1 1 auto; min-width:46px; padding:1px 6px; font-size:12px; }
  .pace { position:absolute; left:100px; top:60px; }
  .left { flex:none; width:100%; } .arena { flex:none; height:60vw; min-height:210px; }
  .legend { font-size:11px; column-gap:8px; } .legend .key { width:12px; }
  .side { flex:none; width:100%; } .side.console, .in-sight { flex:none; overflow:visible; }
  .q-tab { min-height:40px; }
  .log { height:220px; } .timebar { flex-wrap:nowrap; } .wide { display:none !important; }
  .narrow { display:inline-flex !important; }
}
"""
)
