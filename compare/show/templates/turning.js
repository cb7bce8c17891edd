// The body, the vibrissa and its contacts, to be turned, drawn by Zdog on a canvas: no WebGL, no network.
(() => {
  const scene = JSON.parse(document.getElementById("scene-data").textContent);
  const [canvas, slider, said] =
    ["scene-canvas", "scene-station", "scene-said"].map(name => document.getElementById(name));
  const box = scene.high.map((x, i) => x - scene.low[i]);
  const middle = scene.high.map((x, i) => (x + scene.low[i]) / 2);
  const whole = Math.hypot(...box);
  const colour = name => getComputedStyle(canvas).getPropertyValue("--" + name).trim();
  // The page's y points down; x to the right and z to the viewer are those of the case.
  const at = p => ({x: p[0] - middle[0], y: middle[1] - p[1], z: p[2] - middle[2]});
  const line = (points, stroke, color) =>
    new Zdog.Shape({addTo: all, path: points.map(at), closed: false, stroke, color});
  const shaded = light => {
    const rgb = colour("faint").match(/\w\w/g).map(x => Math.round(parseInt(x, 16) * light));
    return `rgba(${rgb}, 0.42)`;
  };

  const picture = new Zdog.Illustration({
    element: canvas, dragRotate: true, rotate: {x: -0.15, y: 0.5}, onDragMove: () => draw(),
    onResize: () => { fit(); draw(); },
  });
  let all, own, zoom = 1;

  function build() {
    if (all) all.remove();
    all = new Zdog.Anchor({addTo: picture});
    for (const [light, ...corners] of scene.faces)
      new Zdog.Shape({addTo: all, path: corners.map(i => at(scene.corners[i])), fill: true,
                      stroke: 0.002, color: shaded(light)});
    line(scene.stations.map(s => s.foot), 0.006, colour("grey"));
    scene.stations.forEach((s, i) => {
      const of_phase = colour(scene.colours[s.phase]);
      if (s.line && i % scene.every === 0) line(s.line, 0.004, of_phase);
      if (s.contact) line([s.contact], 0.018, of_phase);
    });
    show();
  }

  function show() {  // the vibrissa at the slider's station, in pieces, so that the body may hide some
    if (own) own.remove();
    own = new Zdog.Anchor({addTo: all});
    const s = scene.stations[slider.value];
    const piece = (path, stroke, color) =>
      new Zdog.Shape({addTo: own, path: path.map(at), closed: false, stroke, color});
    if (s.line) for (let i = 1; i < s.line.length; i++)
      piece([s.line[i - 1], s.line[i]], 0.02, colour(scene.colours[s.phase]));
    piece([s.foot], 0.05, colour("ink"));
    if (s.contact) piece([s.contact], 0.045, colour("ink"));
    said.textContent = s.said;
    draw();
  }

  function fit() { picture.zoom = zoom * Math.min(picture.width, 2 * picture.height) / whole * 0.9; }
  function draw() { picture.updateRenderGraph(); }
  function closer(factor) { zoom = Math.min(40, Math.max(0.3, zoom * factor)); fit(); draw(); }
  function turn(x, y) { picture.rotate.x += x; picture.rotate.y += y; draw(); }

  slider.max = scene.stations.length - 1;
  slider.value = scene.first;
  slider.addEventListener("input", show);
  for (const button of document.querySelectorAll("[data-zoom]"))
    button.addEventListener("click", () => closer(Number(button.dataset.zoom)));
  canvas.addEventListener("wheel", event => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;  // else the page scrolls
    event.preventDefault();
    closer(Math.exp(-event.deltaY / 400));
  }, {passive: false});
  canvas.addEventListener("keydown", event => {
    const act = {
      ArrowLeft: () => turn(0, 0.1), ArrowRight: () => turn(0, -0.1),
      ArrowUp: () => turn(0.1, 0), ArrowDown: () => turn(-0.1, 0),
      "+": () => closer(1.2), "-": () => closer(1 / 1.2),
    }[event.key];
    if (act) { event.preventDefault(); act(); }
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", build);
  build();
  picture.setResize(true);
})();
