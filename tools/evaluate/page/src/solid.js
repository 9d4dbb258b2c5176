// SPDX-License-Identifier: GPL-3.0-or-later
// One tetrahedral object that can be turned: three.js, drawn only when something changed.
import {
    BufferAttribute,
    BufferGeometry,
    Color,
    DirectionalLight,
    HemisphereLight,
    LineBasicMaterial,
    LineSegments,
    Mesh,
    MeshLambertMaterial,
    PerspectiveCamera,
    Scene,
    Vector3,
    WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { boundary, bounds } from "./tetmesh.js";

const kStart = new Vector3(1.35, -1.75, 1.05);
const kTurn = Math.PI / 24;
const kZoom = 1.12;

export class Solid {
    /** Draws into `canvas`; throws where the browser has no WebGL. */
    constructor(canvas) {
        this.canvas_ = canvas;
        // The drawing is kept so that the page can be printed and looked at by tests.
        this.renderer_ = new WebGLRenderer({
            canvas,
            antialias: true,
            alpha: true,
            preserveDrawingBuffer: true,
        });
        this.scene_ = new Scene();
        this.camera_ = new PerspectiveCamera(32, 1, 0.05, 50);
        this.camera_.up.set(0, 0, 1);
        this.light_();
        this.surface_ = new Mesh(
            new BufferGeometry(),
            new MeshLambertMaterial({
                vertexColors: true,
                flatShading: true,
                polygonOffset: true,
                polygonOffsetFactor: 1,
                polygonOffsetUnits: 1,
            }),
        );
        this.edges_ = new LineSegments(
            new BufferGeometry(),
            new LineBasicMaterial({ color: 0x14171a, transparent: true, opacity: 0.32 }),
        );
        this.scene_.add(this.surface_, this.edges_);
        this.controls_ = new OrbitControls(this.camera_, canvas);
        this.controls_.enablePan = false;
        this.controls_.enableZoom = false; // the wheel scrolls the page; + and - zoom
        this.controls_.addEventListener("change", () => this.draw());
        canvas.addEventListener("keydown", (event) => this.key_(event));
        this.reset();
    }

    light_() {
        const sun = new DirectionalLight(0xffffff, 1.6);
        sun.position.set(-0.5, 0.9, 1);
        this.camera_.add(sun);
        this.scene_.add(this.camera_, new HemisphereLight(0xffffff, 0xdfdfe6, 2.25));
    }

    reset() {
        this.camera_.position.copy(kStart).multiplyScalar(1.27);
        this.controls_.target.set(0, 0, 0);
        this.controls_.update();
        this.draw();
    }

    /** Turns by steps about the vertical and towards the top, as a drag would. */
    turn(sideways, upwards) {
        const offset = this.camera_.position;
        const radius = offset.length();
        const around = Math.atan2(offset.y, offset.x) + sideways * kTurn;
        const height = Math.min(1.5, Math.max(-1.5, Math.asin(offset.z / radius) + upwards * kTurn));
        offset
            .set(Math.cos(height) * Math.cos(around), Math.cos(height) * Math.sin(around), Math.sin(height))
            .multiplyScalar(radius);
        this.controls_.update();
        this.draw();
    }

    zoom(factor) {
        const radius = this.camera_.position.length();
        this.camera_.position.setLength(Math.min(8, Math.max(1.4, radius * factor)));
        this.controls_.update();
        this.draw();
    }

    key_(event) {
        const actions = {
            ArrowLeft: () => this.turn(-1, 0),
            ArrowRight: () => this.turn(1, 0),
            ArrowUp: () => this.turn(0, 1),
            ArrowDown: () => this.turn(0, -1),
            "+": () => this.zoom(1 / kZoom),
            "=": () => this.zoom(1 / kZoom),
            "-": () => this.zoom(kZoom),
            0: () => this.reset(),
        };
        const action = event.ctrlKey || event.metaKey || event.altKey ? undefined : actions[event.key];
        if (!action) return;
        event.preventDefault();
        action();
    }

    resize(width, height) {
        this.renderer_.setPixelRatio(Math.min(2, window.devicePixelRatio));
        this.renderer_.setSize(width, height, false);
        this.camera_.aspect = width / height;
        this.camera_.updateProjectionMatrix();
        this.draw();
    }

    /** Shows the tetrahedra that `kept(t)` says, each in `colour(t)`. */
    show(mesh, behind, kept, colour) {
        const { corners, owners } = boundary(mesh, behind, kept);
        const { low, high } = bounds(mesh.nodes);
        const size = Math.max(...high.map((x, k) => x - low[k]));
        const positions = new Float32Array(3 * corners.length);
        corners.forEach((node, i) => {
            for (let k = 0; k < 3; ++k)
                positions[3 * i + k] = (mesh.nodes[3 * node + k] - (low[k] + high[k]) / 2) / size;
        });
        this.replace_(this.surface_, positions, coloursOf(owners, colour));
        this.replace_(this.edges_, edgePositions(corners, positions));
        this.draw();
    }

    replace_(object, positions, colours) {
        object.geometry.dispose();
        object.geometry = new BufferGeometry();
        object.geometry.setAttribute("position", new BufferAttribute(positions, 3));
        if (colours) object.geometry.setAttribute("color", new BufferAttribute(colours, 3));
    }

    draw() {
        this.renderer_.render(this.scene_, this.camera_);
    }
}

function coloursOf(owners, colour) {
    const colours = new Float32Array(9 * owners.length);
    const known = new Map();
    owners.forEach((tet, i) => {
        const css = colour(tet);
        if (!known.has(css)) known.set(css, new Color(css));
        for (let corner = 0; corner < 3; ++corner) known.get(css).toArray(colours, 9 * i + 3 * corner);
    });
    return colours;
}

/** Each edge of the triangles once. */
function edgePositions(corners, positions) {
    const seen = new Set(),
        points = [];
    for (let i = 0; i < corners.length; ++i) {
        const j = i % 3 === 2 ? i - 2 : i + 1;
        const key = corners[i] < corners[j] ? `${corners[i]},${corners[j]}` : `${corners[j]},${corners[i]}`;
        if (seen.has(key)) continue;
        seen.add(key);
        points.push(...positions.slice(3 * i, 3 * i + 3), ...positions.slice(3 * j, 3 * j + 3));
    }
    return Float32Array.from(points);
}
