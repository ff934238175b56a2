// The 3-D view of a template's page. The page is whole without it: it finds its elements by their id,
// and what cannot be drawn here is said there in words.
//
// Everything that has a meaning comes with the data - colours, ranges, names - so that the picture, its
// legends and the tables cannot disagree.

import {
  AmbientLight,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  Group,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Raycaster,
  Scene,
  ShaderChunk,
  SphereGeometry,
  Spherical,
  SRGBColorSpace,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const element = (id) => document.getElementById(id);

/** The bytes of a script element that holds base64. */
function bytes(id) {
  const text = atob(element(id).textContent.trim());
  return Uint8Array.from(text, (character) => character.charCodeAt(0)).buffer;
}

/** What no number says: of residuals, that no component speaks; of components, that none does. */
const SILENT_RESIDUAL = -32768;
const SILENT_COMPONENT = 65535;

const axes = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };
const start = { azimuth: 0.7, polar: 1.1 };
const step = Math.PI / 24;

function main() {
  const about = JSON.parse(element("report-data").textContent).view;
  const stage = element("stage");
  const canvas = element("canvas");
  let renderer;
  try {
    renderer = webgl(canvas);
  } catch {
    stage.dataset.state = "no-webgl";
    return;
  }
  const positions = new Float32Array(new Uint16Array(bytes("view-positions")));
  for (let i = 0; i < positions.length; i += 1) {
    positions[i] = about.low[i % 3] + about.step * positions[i];
  }
  const residuals = about.measured ? new Int16Array(bytes("view-residuals")) : null;
  const speakers = new Uint16Array(bytes("view-components"));
  const indices = about.surface ? new Uint32Array(widened(bytes("view-indices"), about.wide)) : null;

  const geometry = new BufferGeometry();
  const colours = new BufferAttribute(new Uint8Array(positions.length), 3, true);
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("color", colours);
  if (indices) geometry.setIndex(new BufferAttribute(indices, 1));
  geometry.computeBoundingSphere();
  const { radius } = geometry.boundingSphere;

  const scene = new Scene();
  const materials = indices
    ? { blended: surface(false), apart: surface(true) }
    : { blended: discs(radius * Math.min(5 / Math.sqrt(speakers.length), 1 / 28)) };
  const object = indices ? new Mesh(geometry, materials.blended) : new Points(geometry, materials.blended);
  // Only what is in it is in the object's frame: in the scene y is up, whichever axis is in the object's.
  const root = new Group();
  root.add(object);
  scene.add(root);
  // Mostly ambient, so that a colour stays near its legend's; a light from beside the eye for the shape. Together
  // they are π, what is white to them is white.
  scene.add(new AmbientLight(0xffffff, 1.9));
  const lamp = new DirectionalLight(0xffffff, 1.24);
  const camera = new PerspectiveCamera(35, 1, radius / 50, radius * 50);
  lamp.position.set(-0.5, 0.6, 1);
  camera.add(lamp);
  scene.add(camera);

  const { references, marker } = marks(about, radius, root);

  const controls = new OrbitControls(camera, canvas);
  controls.minDistance = radius / 4;
  controls.maxDistance = radius * 12;
  // The wheel scrolls the page until the view is taken in hand.
  controls.enableZoom = false;
  canvas.addEventListener("pointerdown", (event) => {
    controls.enableZoom = true;
    if (event.pointerType === "mouse") canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener("focus", () => (controls.enableZoom = true));
  canvas.addEventListener("blur", () => (controls.enableZoom = false));

  // Nothing moves by itself: a frame is drawn when something has changed, and then one.
  let asked = false;
  const draw = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      renderer.render(scene, camera);
      stage.dataset.frames = String(Number(stage.dataset.frames ?? 0) + 1);
    });
  };
  controls.addEventListener("change", draw);

  // From a direction, so far away that all of the object is seen, and not farther.
  const distance = (theta, phi) => {
    const back = new Vector3().setFromSphericalCoords(1, phi, theta);
    const right = new Vector3().crossVectors(camera.up, back).normalize();
    const above = new Vector3().crossVectors(back, right);
    const tall = Math.tan((camera.fov * Math.PI) / 360);
    const place = new Vector3();
    let far = 0;
    for (let i = 0; i < positions.length; i += 3) {
      place.fromArray(positions, i).applyMatrix4(root.matrixWorld).sub(controls.target);
      const [x, y] = [Math.abs(place.dot(right)) / camera.aspect, Math.abs(place.dot(above))];
      far = Math.max(far, place.dot(back) + Math.max(x, y) / tall);
    }
    // With room to turn it: what is short from here may be long from there.
    return Math.max(1.12 * far, (0.85 * radius) / Math.sin(Math.atan(tall * Math.min(1, camera.aspect))));
  };
  const width = (theta) => {
    const right = new Vector3(Math.cos(theta), 0, -Math.sin(theta));
    const place = new Vector3();
    let [low, high] = [Infinity, -Infinity];
    for (let i = 0; i < positions.length; i += 3) {
      const across = place.fromArray(positions, i).applyMatrix4(root.matrixWorld).dot(right);
      low = Math.min(low, across);
      high = Math.max(high, across);
    }
    return high - low;
  };
  const look = (spherical) => {
    camera.position.setFromSpherical(spherical).add(controls.target);
    controls.update();
    draw();
  };
  const lookFrom = (theta, phi) => look(new Spherical(distance(theta, phi), phi, theta));
  const middle = () => root.localToWorld(geometry.boundingSphere.center.clone());
  const reset = () => {
    controls.target.copy(middle());
    // Of two sides the one that shows more.
    const sides = [start.azimuth, start.azimuth + Math.PI / 2];
    lookFrom(width(sides[1]) > width(sides[0]) ? sides[1] : sides[0], start.polar);
  };

  const fit = () => {
    const { clientWidth: width, clientHeight: height } = stage;
    if (width === 0 || height === 0) return;
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  };
  const up = element("up");
  const stand = () => {
    root.quaternion.setFromUnitVectors(axes[up.value], axes.y);
    root.updateMatrixWorld();
    marker.hide();
    reset();
  };
  fit();
  stand();
  up.addEventListener("change", stand);
  new ResizeObserver(fit).observe(stage);

  canvas.addEventListener("keydown", (event) => {
    const spherical = new Spherical().setFromVector3(camera.position.clone().sub(controls.target));
    const moves = {
      ArrowLeft: () => (spherical.theta -= step),
      ArrowRight: () => (spherical.theta += step),
      ArrowUp: () => (spherical.phi -= step),
      ArrowDown: () => (spherical.phi += step),
      "+": () => (spherical.radius /= 1.15),
      "-": () => (spherical.radius *= 1.15),
      Home: reset,
    };
    const move = moves[event.key];
    if (!move || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    move();
    if (event.key !== "Home") look(spherical.makeSafe());
  });
  element("reset").addEventListener("click", reset);

  const paint = (view) => {
    const of = painter(view, about, residuals, speakers);
    for (let i = 0; i < speakers.length; i += 1) {
      const [r, g, b] = of(i);
      colours.setXYZ(i, r, g, b);
    }
    colours.needsUpdate = true;
    // Between two components, or between covered and not, there is nothing.
    object.material = (view !== "residual" && materials.apart) || materials.blended;
    for (const reference of references) reference.visible = view === "component";
    for (const legend of document.querySelectorAll("[data-legend]")) {
      legend.hidden = legend.dataset.legend !== view;
    }
    draw();
  };
  const choices = [...document.querySelectorAll('input[name="view"]')];
  for (const choice of choices) {
    choice.addEventListener("change", () => paint(choice.value));
  }
  paint(choices.find((choice) => choice.checked)?.value ?? "component");

  const readout = element("readout");
  const told = readout.textContent;
  const caster = new Raycaster();
  caster.params.Points.threshold = radius / 60;
  const pick = (event) => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const at = new Vector2(
      (2 * (event.clientX - left)) / width - 1,
      1 - (2 * (event.clientY - top)) / height,
    );
    caster.setFromCamera(at, camera);
    const reference = caster.intersectObjects(references.filter((one) => one.visible))[0];
    const hit = caster.intersectObject(object)[0];
    if (reference) {
      marker.hide();
      readout.textContent = about.components[reference.object.userData.component].said;
    } else if (hit) {
      const vertex = indices ? nearest(root.worldToLocal(hit.point), hit.face, positions) : hit.index;
      const place = new Vector3().fromArray(positions, 3 * vertex);
      const speaker = speakers[vertex];
      marker.show(place, references[speaker]?.position);
      readout.textContent = words(about, place, residuals?.[vertex], speaker);
    } else {
      marker.hide();
      readout.textContent = told;
    }
    draw();
  };
  for (const button of document.querySelectorAll("[data-at]")) {
    button.hidden = false;
    button.addEventListener("click", () => {
      const place = new Vector3().fromArray(button.dataset.at.split(" ").map(Number));
      choices.find((choice) => choice.value === "coverage").click();
      controls.target.copy(middle());
      const outwards = root.localToWorld(place.clone()).sub(controls.target);
      const towards = new Spherical().setFromVector3(outwards).makeSafe();
      lookFrom(towards.theta, towards.phi);
      marker.show(place);
      stage.scrollIntoView({ block: "center" });
    });
  }
  let down = null;
  canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
  canvas.addEventListener("pointerup", (event) => {
    // A tap, and not the end of a turn.
    const moved = down && Math.hypot(event.clientX - down[0], event.clientY - down[1]);
    if (moved !== null && moved < 6) pick(event);
    down = null;
  });
  let pointed = false;
  canvas.addEventListener("pointermove", (event) => {
    if (event.pointerType !== "mouse" || event.buttons !== 0 || pointed) return;
    pointed = true;
    requestAnimationFrame(() => {
      pointed = false;
      pick(event);
    });
  });
  stage.dataset.state = "ready";
}

/** Throws where there is none; asked for beforehand, because the renderer complains on the console. */
function webgl(canvas) {
  const context = canvas.getContext("webgl2", {
    alpha: true,
    antialias: true,
    // Printing and saving take the picture between two frames.
    preserveDrawingBuffer: true,
  });
  if (!context) throw new Error("no WebGL");
  const renderer = new WebGLRenderer({ canvas, context, alpha: true, antialias: true, preserveDrawingBuffer: true });
  renderer.setClearColor(0x000000, 0);
  return renderer;
}

/** The object's faces; `apart`: a triangle has one colour, that of a corner, in the place of a blend of three. */
function surface(apart) {
  const material = new MeshLambertMaterial({ vertexColors: true, flatShading: true, side: DoubleSide });
  if (apart) {
    material.onBeforeCompile = (shader) => {
      for (const [stage, chunk] of [["vertexShader", "color_pars_vertex"], ["fragmentShader", "color_pars_fragment"]]) {
        const flat = ShaderChunk[chunk].replaceAll("varying", "flat varying");
        shader[stage] = shader[stage].replace(`#include <${chunk}>`, flat);
      }
    };
    material.customProgramCacheKey = () => "apart";
  }
  return material;
}

/** Points as discs of a width in the object's unit, so large that few of them make a surface too. */
function discs(size) {
  const material = new PointsMaterial({ vertexColors: true, size });
  material.onBeforeCompile = (shader) => {
    const chunk = "#include <clipping_planes_fragment>";
    const round = "if (distance(gl_PointCoord, vec2(0.5)) > 0.5) discard;";
    shader.fragmentShader = shader.fragmentShader.replace(chunk, `${chunk}\n${round}`);
  };
  return material;
}

/** Indices as they came: four bytes each, or two. */
const widened = (buffer, wide) => (wide ? new Uint32Array(buffer) : new Uint16Array(buffer));

/** Bytes of the working space, which is linear, from what the page's style sheet would call the colour. */
function linear(hex) {
  const { r, g, b } = new Color().set(hex);
  return [r, g, b];
}

/** The colour of a vertex in a view. */
function painter(view, about, residuals, speakers) {
  const silent = linear(about.colours.silent);
  if (view === "component") {
    const own = about.components.map((component) => linear(component.colour));
    return (i) => own[speakers[i]] ?? silent;
  }
  const open = linear(about.colours.uncovered);
  if (view === "coverage") {
    const covered = linear(about.colours.covered);
    return (i) => (isCovered(residuals[i], about) ? covered : open);
  }
  const ramp = about.colours.ramp.map(linear);
  return (i) => {
    if (residuals[i] === SILENT_RESIDUAL) return open;
    const share = (Math.abs(residuals[i]) * about.residualStep) / about.tau;
    return share > 1 ? open : ramp[Math.round(share * (ramp.length - 1))];
  };
}

function isCovered(residual, about) {
  return residual !== SILENT_RESIDUAL && Math.abs(residual) * about.residualStep <= about.tau;
}

/** The corner of the triangle that was hit that is nearest to the place. */
function nearest(point, { a, b, c }, positions) {
  const corners = [a, b, c];
  const away = (i) => point.distanceToSquared(new Vector3().fromArray(positions, 3 * i));
  return corners.reduce((best, corner) => (away(corner) < away(best) ? corner : best));
}

/** What is known of a place, in a line. */
function words(about, place, residual, speaker) {
  const at = place.toArray().map((c) => c.toFixed(about.digits)).join(", ");
  const said = [`(${at}) ${about.unit}`];
  if (residual === undefined) {
    said.push(about.components[speaker].said);
  } else if (residual === SILENT_RESIDUAL || speaker === SILENT_COMPONENT) {
    said.push("no component speaks here: not covered");
  } else {
    const size = Math.abs(residual) * about.residualStep;
    const most = 32767 * about.residualStep;
    const length = `${size >= most ? "at least " : ""}${size.toFixed(about.residualDigits)} mm`;
    said.push(`residual ${length}, ${isCovered(residual, about) ? "covered" : "not covered"}`);
    said.push(about.components[speaker].said);
  }
  return said.join(" · ");
}

/** The reference points, and a mark for the place that is pointed at. */
function marks(about, radius, root) {
  const ball = new SphereGeometry(radius / 45, 20, 14);
  const ink = { depthTest: false, transparent: true };
  const references = about.components.map((component, index) => {
    const colour = new Color().setStyle(component.colour, SRGBColorSpace);
    const rim = new Mesh(ball, new MeshBasicMaterial({ color: 0x1c2028, ...ink }));
    const inside = new Mesh(ball, new MeshBasicMaterial({ color: colour, ...ink }));
    inside.scale.setScalar(0.72);
    rim.renderOrder = 2;
    inside.renderOrder = 3;
    rim.add(inside);
    rim.position.fromArray(component.centre);
    rim.userData.component = inside.userData.component = index;
    root.add(rim);
    return rim;
  });
  const dot = new Mesh(ball, new MeshBasicMaterial({ color: 0x1c2028, ...ink }));
  dot.scale.setScalar(0.45);
  dot.renderOrder = 4;
  const ends = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
  const line = new Line(ends, new LineBasicMaterial({ color: 0x1c2028, ...ink }));
  line.renderOrder = 4;
  line.frustumCulled = false;
  const marker = {
    show(place, from) {
      dot.position.copy(place);
      dot.visible = true;
      line.visible = from !== undefined;
      if (from) {
        place.toArray(ends.attributes.position.array, 0);
        from.toArray(ends.attributes.position.array, 3);
        ends.attributes.position.needsUpdate = true;
      }
    },
    hide() {
      dot.visible = line.visible = false;
    },
  };
  marker.hide();
  root.add(dot, line);
  return { references, marker };
}

main();
