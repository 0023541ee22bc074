"""Colours and sizes of the page, for light and dark.

The page does without Tailwind: in the browser it looks at every change of the page and writes its style sheet anew,
at 20 Hz most of a core.  Of its names those that are used stand here, with its meaning.
"""

from __future__ import annotations

from typing import Final

UTILITIES: Final = """
.w-full { width:100%; } .bg-transparent { background:transparent; } .p-1 { padding:4px; }
.items-center { align-items:center; } .items-start { align-items:flex-start; } .items-end { align-items:flex-end; }
.no-wrap { flex-wrap:nowrap; } .gap-0 { gap:0; }
.gap-1 { gap:4px; } .gap-2 { gap:8px; } .gap-3 { gap:12px; } .gap-4 { gap:16px; }
.gap-x-4 { column-gap:16px; } .gap-x-6 { column-gap:24px; } .gap-y-0 { row-gap:0; } .gap-y-1 { row-gap:4px; }
.w-20 { width:80px; } .w-24 { width:96px; } .w-28 { width:112px; } .w-32 { width:128px; } .w-36 { width:144px; }
.w-40 { width:160px; } .w-44 { width:176px; } .w-52 { width:208px; } .w-64 { width:256px; }
"""

CSS: Final = (
    UTILITIES
    + """
:root { --ink:#17202b; --soft:#52606d; --paper:#ffffff; --panel:#f4f6f8; --line:#cfd6dd; --wall:#2f3944;
  --true:#08736e; --odo:#1d57b8; --cloud:#b93a0a; --beam:#b98500; --real:#6b21a8; --post:#7d8894; --loaded:#6d7a18;
  --run:#087443; --wait:#9a6200; --bad:#b42318; --mark:#fff3c4; }
.body--dark { --ink:#e6ebf0; --soft:#a3b0bd; --paper:#12171d; --panel:#1b222a; --line:#36414c; --wall:#c3ccd5;
  --true:#3ecfc4; --odo:#7fb0ff; --cloud:#ff9a70; --beam:#f0c04a; --real:#c9a4f7; --post:#8b97a3; --loaded:#c7d66a;
  --run:#4bd28f; --wait:#f0b44a; --bad:#ff8a80; --mark:#4a3f12; }
body { background:var(--paper); color:var(--ink); font-size:13px; }
.nicegui-content { padding:8px 12px; gap:8px; }
.panel { background:var(--panel); border:1px solid var(--line); border-radius:6px; padding:8px; color:var(--ink); }
.soft { color:var(--soft); }
.head { font-weight:600; font-size:13px; }
.mono, .mono td, .mono th, .mono .nicegui-log, .mono div { font-family:ui-monospace,
  "DejaVu Sans Mono",Menlo,Consolas,monospace; font-size:12px; }
.q-uploader__list { display:none; }
.value { font-variant-numeric:tabular-nums; white-space:pre; }
.one-line { flex:1 1 0; min-width:0; overflow:hidden; text-overflow:ellipsis; }
.findings .q-table--col-auto-width { display:none; }
.chip { padding:2px 10px; border-radius:10px; font-weight:600; border:1px solid currentColor; }
.chip.run { color:var(--run); } .chip.wait { color:var(--wait); } .chip.bad { color:var(--bad); }
.side { max-height:calc(100vh - 116px); overflow-y:auto; }
.big { font-size:17px; font-weight:700; min-width:130px; min-height:44px; }
/* Or the line that an image stands on adds to the lowest layer's height, and the layers do not fit each other. */
.arena img, .lanes img { display:block; }
.arena svg, .lanes svg { overflow:visible; }
/* Each layer is painted by itself: a robot that moves leaves the cloud alone. */
.arena svg { will-change:transform; }
.arena { background:var(--paper); border:1px solid var(--line); border-radius:6px; overflow:hidden; }
.grid path { stroke:var(--line); stroke-width:1; fill:none; } .grid text { fill:var(--soft); font-size:13px; }
.wall { stroke:var(--wall); stroke-width:5; stroke-linecap:round; fill:none; }
.post { fill:var(--post); stroke:var(--wall); stroke-width:2; }
.robot circle { fill:var(--true); fill-opacity:.25; stroke:var(--true); stroke-width:3; }
.robot path { stroke:var(--true); stroke-width:4; fill:none; } .robot .pressed { stroke:var(--bad); stroke-width:7; }
.ghost circle { fill:none; stroke:var(--odo); stroke-width:2.5; stroke-dasharray:6 5; }
.ghost path { stroke:var(--odo); stroke-width:2.5; stroke-dasharray:6 5; fill:none; }
.held circle { fill:var(--wait); fill-opacity:.3; stroke:var(--wait); stroke-width:3; }
.held path { stroke:var(--wait); stroke-width:3; fill:none; }
.beam { fill:var(--beam); fill-opacity:.14; stroke:none; } .measured { stroke:var(--beam); stroke-width:3; fill:none; }
.ray { stroke:var(--real); stroke-width:1.2; stroke-dasharray:3 4; fill:none; }
.hit { stroke:var(--real); stroke-width:2.5; fill:none; } .echo { stroke:var(--real); stroke-width:3; fill:none; }
.trail-true { stroke:var(--true); stroke-width:2.5; fill:none; }
.trail-odo { stroke:var(--odo); stroke-width:2; stroke-dasharray:7 4; fill:none; }
.trail-loaded { stroke:var(--loaded); stroke-width:2; fill:none; }
.cloud { stroke:var(--cloud); stroke-width:5; stroke-linecap:round; fill:none; }
.cloud-loaded { stroke:var(--loaded); stroke-width:4; stroke-linecap:round; fill:none; }
.key { display:inline-block; width:18px; height:0; border-top:3px solid; vertical-align:middle; margin-right:4px; }
.code { background:var(--paper); border:1px solid var(--line); border-radius:4px; padding:4px; overflow-x:auto; }
.code div { white-space:pre; } .code .here { background:var(--mark); font-weight:600; }
.lanes text { fill:var(--ink); font-size:13px; } .lanes .axis { stroke:var(--line); }
.lanes .running { fill:var(--run); } .lanes .ready { fill:var(--wait); fill-opacity:.55; }
.lanes .waiting { fill:var(--bad); } .lanes .raised { stroke:var(--real); stroke-width:3; }
.lanes .many { fill-opacity:.4; }
.lanes .level { stroke:var(--odo); stroke-width:1.6; fill:none; } .lanes .level.many { fill:var(--odo); stroke:none; }
.lanes .bus { stroke:var(--true); stroke-width:1.3; fill:var(--paper); }
.lanes .busy { fill:var(--true); fill-opacity:.4; }
.lanes .word { font-family:ui-monospace,"DejaVu Sans Mono",Menlo,Consolas,monospace; font-size:11px; }
.lanes .small { fill:var(--soft); font-size:10px; }
.lanes .cursor { stroke:var(--ink); stroke-width:1.5; stroke-dasharray:4 3; }
.q-table th { font-weight:600; } .q-table td, .q-table th { font-size:12px; padding:3px 8px !important; height:auto; }
.q-table__card { background:transparent; color:var(--ink); }
.body--dark .q-btn--outline.text-primary, .body--dark .q-btn--flat.text-primary { --q-primary:#8ab8ff; }
.q-tab { min-height:34px; }
"""
)
