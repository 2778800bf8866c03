/** The gel and the indenter in three dimensions. */

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Color,
  CylinderGeometry,
  DirectionalLight,
  Group,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  Mesh as Drawn,
  MeshBasicMaterial,
  MeshStandardMaterial,
  PerspectiveCamera,
  Plane,
  Raycaster,
  Scene as World,
  Sprite,
  SpriteMaterial,
  SRGBColorSpace,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { Scale, colourOf } from "./colours.ts";
import type { Frame, Mesh, Outline, Pose, Sensor } from "./engine.ts";
import type { Left } from "./press.ts";

/** How the gel is coloured. */
export type Colouring = "pressure" | "von-mises" | "plain";

const PLAIN = new Color(0x9fb4c4);

export class Scene {
  readonly scale = new Scale();
  private readonly world = new World();
  private readonly camera = new PerspectiveCamera(35, 1, 1, 1000);
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly surroundings = new Group();
  private readonly gel = new Drawn(
    new BufferGeometry(),
    new MeshStandardMaterial({ vertexColors: true, roughness: 0.55, metalness: 0, transparent: true, opacity: 0.92 }),
  );
  private readonly metal = new MeshStandardMaterial({ color: 0x8d99a6, roughness: 0.35, metalness: 0.2, transparent: true, opacity: 0.38, depthWrite: false });
  private readonly indenter = new Drawn(new BufferGeometry(), this.metal);
  /** Shapes that were left in the gel. */
  private readonly others = new Group();
  /** The node that each drawn corner follows: a node at an edge has a corner for each side. */
  private nodes = new Uint32Array();
  private rest_mm: Float32Array = new Float32Array();
  private ports: Drawn<CylinderGeometry, MeshBasicMaterial>[] = [];
  private isStale = true;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio || 1));
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableZoom = false;
    this.controls.maxPolarAngle = 1.5;
    this.controls.addEventListener("change", () => (this.isStale = true));
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(-20, -40, 70);
    this.indenter.renderOrder = 2;
    this.world.add(new HemisphereLight(0xffffff, 0x8090a0, 1.5), sun, this.surroundings, this.gel, this.indenter, this.others);
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /** Whether a drag turns the view. */
  set turns(turns: boolean) {
    this.controls.enabled = turns;
  }

  /** Turns the view by angles, radians, and brings it nearer by a factor. */
  look(around: number, up: number, nearer: number): void {
    const way = this.camera.position.clone().sub(this.controls.target);
    const [distance, polar] = [way.length() / nearer, Math.acos(way.z / way.length())];
    const angle = Math.atan2(way.y, way.x) + around;
    const raised = Math.min(1.5, Math.max(0.05, polar - up));
    way.set(Math.sin(raised) * Math.cos(angle), Math.sin(raised) * Math.sin(angle), Math.cos(raised)).multiplyScalar(distance);
    this.camera.position.copy(this.controls.target).add(way);
    this.camera.lookAt(this.controls.target);
    this.isStale = true;
  }

  sensor(sensor: Sensor): void {
    const [low, high] = sensor.gel_mm.map((corner) => new Vector3(...corner)) as [Vector3, Vector3];
    const size = high.clone().sub(low);
    const middle = low.clone().add(high).multiplyScalar(0.5);
    this.surroundings.clear();
    const margin = 3 + (sensor.shell?.gap_mm ?? 0);
    const board = new Drawn(
      new BoxGeometry(size.x + 2 * margin, size.y + 2 * margin, 1.6),
      new MeshStandardMaterial({ color: 0x2f5d50, roughness: 0.8 }),
    );
    board.position.set(middle.x, middle.y, -0.86);
    this.surroundings.add(board);
    this.ports = sensor.taxels.map((taxel) => {
      const radius_mm = Math.max(0.4, taxel.port_radius_mm);
      const port = new Drawn(new CylinderGeometry(radius_mm, radius_mm, 0.1, 32), new MeshBasicMaterial());
      port.rotation.x = Math.PI / 2;
      port.position.set(...taxel.position_mm);
      this.surroundings.add(port);
      return port;
    });
    if (sensor.shell) this.surroundings.add(shellOf(low, high, sensor.shell));
    this.surroundings.add(axesOf(low, high, getComputedStyle(this.canvas).color));
    const reach = size.length();
    this.controls.target.set(middle.x - 2.5, middle.y - 1, 0.55 * high.z);
    this.camera.position.set(middle.x - 0.42 * reach, middle.y - 1.42 * reach, 0.98 * reach);
    this.controls.update();
    this.isStale = true;
  }

  outline(outline: Outline): void {
    this.indenter.geometry.dispose();
    this.indenter.geometry = geometryOf(outline);
    this.isStale = true;
  }

  /** Shapes that stay where they are. */
  left(shapes: Left[]): void {
    for (const other of this.others.children) (other as Drawn).geometry.dispose();
    const drawn = shapes.map(({ outline, gel_from_indenter }) => {
      const other = new Drawn(geometryOf(outline), this.metal);
      other.renderOrder = 2;
      other.position.set(...gel_from_indenter.position_mm);
      other.quaternion.set(...gel_from_indenter.rotation);
      return other;
    });
    this.others.clear();
    if (drawn.length) this.others.add(...drawn);
    this.isStale = true;
  }

  mesh({ rest_mm, surface_triangles }: Mesh): void {
    const corners = new Map<number, number>();
    const nodes: number[] = [];
    const index = surface_triangles.map((node, place) => {
      const side = sideOf(rest_mm, surface_triangles, place - (place % 3));
      const key = 6 * node + side;
      const known = corners.get(key);
      if (known !== undefined) return known;
      corners.set(key, nodes.length);
      return nodes.push(node) - 1;
    });
    this.nodes = Uint32Array.from(nodes);
    this.rest_mm = rest_mm;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * nodes.length), 3));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(3 * nodes.length), 3));
    geometry.setIndex(new BufferAttribute(index, 1));
    this.gel.geometry.dispose();
    this.gel.geometry = geometry;
    this.gel.frustumCulled = false;
    this.isStale = true;
  }

  frame(frame: Frame, pose: Pose, colouring: Colouring, magnified: number): void {
    const values = colouring === "von-mises" ? frame.node_von_mises_kpa : frame.node_pressure_kpa;
    this.scale.take(colouring === "plain" ? frame.pressure_kpa : values);
    const { geometry } = this.gel;
    const [places, colours] = [geometry.getAttribute("position"), geometry.getAttribute("color")];
    const colour = new Color();
    this.nodes.forEach((node, corner) => {
      const at = (axis: number) => this.rest_mm[3 * node + axis]! + magnified * frame.displacements_mm[3 * node + axis]!;
      places.setXYZ(corner, at(0), at(1), at(2));
      if (colouring === "plain") colour.copy(PLAIN);
      else this.colourInto(colour, values[node]!);
      colours.setXYZ(corner, colour.r, colour.g, colour.b);
    });
    places.needsUpdate = colours.needsUpdate = true;
    geometry.computeVertexNormals();
    frame.pressure_kpa.forEach((kpa, taxel) => this.colourInto(this.ports[taxel]!.material.color, kpa));
    this.indenter.position.set(...pose.position_mm);
    this.indenter.quaternion.set(...pose.rotation);
    this.isStale = true;
  }

  private colourInto(colour: Color, kpa: number): void {
    const [r, g, b] = colourOf(this.scale.part(kpa));
    colour.setRGB(r / 255, g / 255, b / 255, SRGBColorSpace);
  }

  /** Where a point of the screen meets the plane at a height, mm. */
  at(x_px: number, y_px: number, height_mm: number): [number, number] | undefined {
    const box = this.canvas.getBoundingClientRect();
    const caster = new Raycaster();
    const place = new Vector2((2 * (x_px - box.left)) / box.width - 1, 1 - (2 * (y_px - box.top)) / box.height);
    caster.setFromCamera(place, this.camera);
    const met = caster.ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -height_mm), new Vector3());
    return met ? [met.x, met.y] : undefined;
  }

  /** Where on the screen a point of the gel's frame is, px. */
  onScreen(x_mm: number, y_mm: number, z_mm: number): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    const place = new Vector3(x_mm, y_mm, z_mm).project(this.camera);
    return [box.left + ((place.x + 1) / 2) * box.width, box.top + ((1 - place.y) / 2) * box.height];
  }

  /** Draws, where anything has changed. */
  render(): void {
    if (!this.isStale) return;
    this.isStale = false;
    this.renderer.render(this.world, this.camera);
  }

  private resize(): void {
    const [width, height] = [this.canvas.clientWidth || 1, this.canvas.clientHeight || 1];
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // As much is seen across on a narrow screen.
    this.camera.fov = Math.min(70, (2 * Math.atan(Math.tan(Math.PI * (35 / 360)) * Math.max(1, 1.25 / this.camera.aspect)) * 180) / Math.PI);
    this.camera.updateProjectionMatrix();
    this.isStale = true;
  }
}

function geometryOf({ corners_mm, normals, triangles }: Outline): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(corners_mm, 3));
  geometry.setAttribute("normal", new BufferAttribute(normals, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  return geometry;
}

/** The side that a triangle of the gel at rest looks to: two for each axis. */
function sideOf(rest_mm: Float32Array, triangles: Uint32Array, first: number): number {
  const corner = (i: number) => new Vector3().fromArray(rest_mm, 3 * triangles[first + i]!);
  const [a, b, c] = [corner(0), corner(1), corner(2)];
  const normal = b.sub(a).cross(c.sub(a)).toArray();
  const sizes = normal.map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  return 2 * axis + (normal[axis]! > 0 ? 1 : 0);
}

function shellOf(low: Vector3, high: Vector3, shell: { gap_mm: number; height_mm: number }): Group {
  const group = new Group();
  const material = new MeshStandardMaterial({ color: 0x59636e, roughness: 0.7 });
  const [thick, gap] = [1.5, shell.gap_mm];
  const [width, depth] = [high.x - low.x + 2 * (gap + thick), high.y - low.y + 2 * gap];
  const [x, y, z] = [(low.x + high.x) / 2, (low.y + high.y) / 2, shell.height_mm / 2];
  const wall = (size: [number, number], at: [number, number]) => {
    const wall = new Drawn(new BoxGeometry(...size, shell.height_mm), material);
    wall.position.set(...at, z);
    group.add(wall);
  };
  wall([width, thick], [x, low.y - gap - thick / 2]);
  wall([width, thick], [x, high.y + gap + thick / 2]);
  wall([thick, depth], [low.x - gap - thick / 2, y]);
  wall([thick, depth], [high.x + gap + thick / 2, y]);
  return group;
}

/** Axes beside the gel, with ticks each 5 mm. */
function axesOf(low: Vector3, high: Vector3, ink: string): Group {
  const group = new Group();
  const off = 6;
  const ends: number[] = [];
  const line = (from: [number, number, number], to: [number, number, number]) => ends.push(...from, ...to);
  const label = (text: string, at: [number, number, number]) => group.add(labelOf(text, at, ink));
  const ticks = (from: number, to: number) => {
    const found: number[] = [];
    for (let tick = Math.ceil(from / 5) * 5; tick <= to + 1e-9; tick += 5) found.push(tick);
    return found;
  };
  const [front, left] = [low.y - off, low.x - off];
  line([low.x, front, 0], [high.x, front, 0]);
  for (const x of ticks(low.x, high.x)) {
    line([x, front, 0], [x, front - 1, 0]);
    label(String(x), [x, front - 2.4, 0]);
  }
  label("x (mm)", [(low.x + high.x) / 2, front - 5.6, 0]);
  line([left, low.y, 0], [left, high.y, 0]);
  for (const y of ticks(low.y, high.y)) {
    line([left, y, 0], [left - 1, y, 0]);
    label(String(y), [left - 2.6, y, 0]);
  }
  label("y (mm)", [left - 6.5, (low.y + high.y) / 2, 0]);
  line([left, high.y, 0], [left, high.y, high.z]);
  for (const z of ticks(0, high.z).slice(1)) {
    line([left, high.y, z], [left - 1, high.y, z]);
    label(String(z), [left - 2.6, high.y, z]);
  }
  label("z (mm)", [left - 1, high.y, high.z + 2]);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
  group.add(new LineSegments(geometry, new LineBasicMaterial({ color: new Color(ink) })));
  return group;
}

function labelOf(text: string, at: [number, number, number], ink: string): Sprite {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [256, 64];
  const context = canvas.getContext("2d")!;
  context.font = "44px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = ink;
  context.fillText(text, 128, 34);
  const sprite = new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), transparent: true, depthTest: false }));
  sprite.scale.set(8.4, 2.1, 1);
  sprite.position.set(...at);
  return sprite;
}
