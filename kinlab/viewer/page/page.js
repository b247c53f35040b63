// kinlab's page: sliders, read-out, labels and animation around meshcat's viewer.
//
// Everything that moves is computed here, so a saved page needs no server. Matrices are flat
// arrays of 16 numbers, row by row; meshcat's set_transform wants columns, see place().
// Needs the globals MeshCat and viewer (meshcat's own script); start(spec) does the rest.
"use strict";

const kinlab = (() => {
  const THREE = MeshCat.THREE;

  // ---- words: English here; start(spec) is given those of another language ---------------

  let words = {};
  const _ = (text) => words[text] || text;
  const fill = (text, values) => text.replace(/\{(\w+)\}/g, (whole, name) => values[name]);

  // ---- small linear algebra ------------------------------------------------------------

  const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
  ];
  const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
  const origin = (T) => [T[3], T[7], T[11]];
  const rotate = (T, v) => [0, 4, 8].map((r) => T[r] * v[0] + T[r + 1] * v[1] + T[r + 2] * v[2]);

  function multiply(A, B) {
    const out = new Array(16).fill(0);
    for (let i = 0; i < 4; i++)
      for (let j = 0; j < 4; j++)
        for (let k = 0; k < 4; k++) out[4 * i + j] += A[4 * i + k] * B[4 * k + j];
    return out;
  }

  // Rotation by an angle about a unit axis (Rodrigues), or a shift along it.
  function jointMotion(type, [x, y, z], q) {
    if (type === "prismatic") return [1, 0, 0, q * x, 0, 1, 0, q * y, 0, 0, 1, q * z, 0, 0, 0, 1];
    const c = Math.cos(q), s = Math.sin(q), u = 1 - c;
    return [
      c + u * x * x, u * x * y - s * z, u * x * z + s * y, 0,
      u * x * y + s * z, c + u * y * y, u * y * z - s * x, 0,
      u * x * z - s * y, u * y * z + s * x, c + u * z * z, 0,
      0, 0, 0, 1,
    ];
  }

  // Singular values of A (rows x columns), largest first, and the left singular vectors: Jacobi
  // rotations make the rows orthogonal; their lengths are the singular values (Hestenes 1958).
  // Squaring A, as the eigenvalues of A A^T do, would lose half the digits near a singularity.
  function svd(A) {
    const m = A.length;
    const rows = A.map((row) => row.slice());
    const vectors = A.map((_, i) => A.map((_, j) => (i === j ? 1 : 0)));
    for (let sweep = 0, turned = true; turned && sweep < 60; sweep++) {
      turned = false;
      for (let i = 0; i < m; i++)
        for (let j = i + 1; j < m; j++) {
          const a = dot(rows[i], rows[i]), b = dot(rows[j], rows[j]), g = dot(rows[i], rows[j]);
          if (Math.abs(g) <= 1e-16 * Math.sqrt(a * b) || g === 0) continue;
          turned = true;
          const zeta = (b - a) / (2 * g);
          const t = (zeta < 0 ? -1 : 1) / (Math.abs(zeta) + Math.hypot(1, zeta));
          const c = 1 / Math.hypot(1, t), s = c * t;
          for (const set of [rows, vectors]) {
            const [p, r] = [set[i], set[j]];
            set[i] = p.map((x, k) => c * x - s * r[k]);
            set[j] = p.map((x, k) => s * x + c * r[k]);
          }
        }
    }
    const found = rows.map((row, i) => ({ sigma: Math.hypot(...row), vector: vectors[i] }));
    return found.sort((p, r) => r.sigma - p.sigma);
  }

  function determinant(A) {
    const M = A.map((row) => row.slice());
    let value = 1;
    for (let k = 0; k < M.length; k++) {
      let best = k;
      for (let i = k + 1; i < M.length; i++) if (Math.abs(M[i][k]) > Math.abs(M[best][k])) best = i;
      if (M[best][k] === 0) return 0;
      if (best !== k) {
        [M[best], M[k]] = [M[k], M[best]];
        value = -value;
      }
      value *= M[k][k];
      for (let i = k + 1; i < M.length; i++) {
        const f = M[i][k] / M[k][k];
        for (let j = k; j < M.length; j++) M[i][j] -= f * M[k][j];
      }
    }
    return value;
  }

  // sigma_min, condition number and, where J is square, the determinant.
  function metrics(J) {
    const count = Math.min(J.length, J[0].length);
    const sigma = svd(J).slice(0, count).map((s) => s.sigma);
    const least = sigma[count - 1];
    const kappa = least > 1e-12 * sigma[0] ? sigma[0] / least : Infinity;
    return { sigma, sigmaMin: least, kappa, det: J.length === J[0].length ? determinant(J) : null };
  }

  // ---- mechanisms: what moves when a slider does ---------------------------------------

  // A serial arm. frames(q): every joint frame in the base, then the tool.
  function serialArm(spec) {
    const { joints, tool, rows } = spec;
    function frames(q) {
      const out = [];
      let T = IDENTITY;
      joints.forEach((joint, i) => {
        T = multiply(multiply(T, joint.placement), jointMotion(joint.type, joint.axis, q[i]));
        out.push(T);
      });
      out.push(multiply(T, tool));
      return out;
    }
    // Linear rows first, axes of the base, reference point the tool origin.
    function jacobian(q) {
      const all = frames(q);
      const p = origin(all[joints.length]);
      const columns = joints.map((joint, i) => {
        const axis = rotate(all[i], joint.axis);
        if (joint.type === "prismatic") return [...axis, 0, 0, 0];
        return [...cross(axis, p.map((x, k) => x - origin(all[i])[k])), ...axis];
      });
      return [0, 1, 2, 3, 4, 5].map((r) => columns.map((column) => column[r]));
    }
    return {
      joints,
      frames,
      jacobian,
      task: (q) => rows.map((r) => jacobian(q)[r]),
      linear: (q) => jacobian(q).slice(0, 3),
      tool: (q) => frames(q)[joints.length],
      admit: (from, to) => ({ q: to, stopped: "" }),
      place(q) {
        joints.forEach((joint, i) => {
          const motion = jointMotion(joint.type, joint.axis, q[i]);
          place(joint.path, multiply(joint.placement, motion));
        });
        (spec.followers || []).forEach((joint) => {
          const motion = jointMotion(joint.type, joint.axis, q[joint.joint]);
          place(joint.path, multiply(joint.placement, motion));
        });
        for (const row of spec.dh) drawDhRow(row, q);
      },
    };
  }

  // A five-bar in its plane: cranks about (+e, 0) and (-e, 0), rods that meet at the tool.
  // The tool is where two circles about the elbows cut, on the side that `assembly` names.
  function fiveBar(spec) {
    const { l1, l2, e, assembly, joints, home } = spec;
    const pins = [e, -e];
    function loop(q) {
      const u = q.map((angle) => [Math.cos(angle), Math.sin(angle)]);
      const elbow = u.map((d, i) => [pins[i] + l1[i] * d[0], l1[i] * d[1]]);
      const across = [elbow[1][0] - elbow[0][0], elbow[1][1] - elbow[0][1]];
      const gap = Math.hypot(...across);
      const along = (gap * gap + l2[0] * l2[0] - l2[1] * l2[1]) / (2 * gap);
      const height2 = l2[0] * l2[0] - along * along;
      if (!(gap > 0) || height2 < 0) return null;
      const height = assembly * Math.sqrt(height2);
      const n = [across[0] / gap, across[1] / gap];
      const tool = [
        elbow[0][0] + along * n[0] - height * n[1],
        elbow[0][1] + along * n[1] + height * n[0],
      ];
      const w = elbow.map((b, i) => [(tool[0] - b[0]) / l2[i], (tool[1] - b[1]) / l2[i]]);
      return { u, elbow, tool, w, sine: Math.abs(w[0][0] * w[1][1] - w[0][1] * w[1][0]) };
    }
    // theta_dot = J v (note 003): row i is w_i / (l1_i u_i x w_i).
    function rates(q) {
      const { u, w } = loop(q);
      return w.map((r, i) => {
        const drive = l1[i] * (u[i][0] * r[1] - u[i][1] * r[0]);
        return [r[0] / drive, r[1] / drive];
      });
    }
    function jacobian(q) {
      const [[a, b], [c, d]] = rates(q);
      const det = a * d - b * c;
      return [[d / det, -b / det], [-c / det, a / det]];
    }
    // Walks from a closed pose towards another in small steps; stops where the rods come into
    // line, since beyond it the loop cannot close or the tool could take either side.
    function admit(from, to) {
      const at = (t) => from.map((x, i) => x + t * (to[i] - x));
      const open = (t) => {
        const pose = loop(at(t));
        return pose === null || pose.sine < spec.least_sine;
      };
      const steps = Math.max(1, Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) / 0.01));
      for (let k = 1; k <= steps; k++) {
        if (!open(k / steps)) continue;
        let [good, bad] = [(k - 1) / steps, k / steps];
        for (let i = 0; i < 40; i++) {
          const middle = (good + bad) / 2;
          if (open(middle)) bad = middle;
          else good = middle;
        }
        return { q: at(good), stopped: _("type II singularity: the rods are in line") };
      }
      return { q: to, stopped: "" };
    }
    const bar = (angle, x, y) => {
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      return [c, -s, 0, x, s, c, 0, y, 0, 0, 1, 0, 0, 0, 0, 1];
    };
    const tool = (q) => bar(0, ...loop(q).tool);
    return {
      joints,
      loop,
      admit,
      tool,
      task: rates,
      linear: (q) => [...jacobian(q), [0, 0]],
      place(q) {
        const pose = loop(q);
        for (const i of [0, 1]) {
          place(`${home}/crank${i + 1}`, bar(q[i], pins[i], 0));
          const [wx, wy] = pose.w[i];
          place(`${home}/rod${i + 1}`, bar(Math.atan2(wy, wx), ...pose.elbow[i]));
        }
        place(`${home}/tool`, tool(q));
      },
    };
  }

  // ---- drawing -------------------------------------------------------------------------

  function number(value, digits = 4) {
    if (value === Infinity) return "∞";
    const size = Math.abs(value);
    if (size < 1e-12) return "0";
    const plain = size >= 1e-3 && size < 1e5;
    if (plain) return String(Number(value.toPrecision(digits)));
    return value.toExponential(Math.max(0, digits - 2));
  }

  // A number with so many places; what rounds to zero has no sign.
  function fixed(value, places) {
    const text = value.toFixed(places);
    return Number(text) === 0 ? text.replace("-", "") : text;
  }

  // The same without idle zeros: 90, 1.5, 0.002.
  const brief = (value, places) => String(Number(fixed(value, places)));

  const node = (path) => viewer.scene_tree.find(path.split("/").filter((x) => x)).object;

  function place(path, T) {
    const columns = [0, 1, 2, 3].flatMap((c) => [0, 4, 8, 12].map((r) => T[r + c]));
    viewer.handle_command({ type: "set_transform", path, matrix: columns });
  }

  const degrees = (angle) => `${brief((angle * 180) / Math.PI, 3)}°`;
  const metres = (length) => (Math.abs(length) < 5e-7 ? "0" : number(length));

  function dhValues(row, q) {
    const move = row.sign * q[row.joint];
    const theta = row.revolute ? row.theta + move : row.theta;
    return {
      theta: Math.atan2(Math.sin(theta), Math.cos(theta)),
      d: row.revolute ? row.d : row.d + move,
    };
  }

  const arcPaint = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });

  // d and theta of one DH row: a rod along z and an arc about it, at the foot of the row.
  function drawDhRow(row, q) {
    const { theta, d } = dhValues(row, q);
    place(`${row.path}/d`, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, d || 1e-9, 0, 0, 0, 0, 1]);
    const arc = node(`${row.path}/theta`);
    for (const old of arc.children.slice()) {
      arc.remove(old);
      old.geometry.dispose();
    }
    if (Math.abs(theta) < 1e-3) return;
    const ring = new THREE.TorusGeometry(row.radius, row.radius / 24, 8, 40, Math.abs(theta));
    const mesh = new THREE.Mesh(ring, arcPaint);
    arcPaint.color.set(row.color);
    mesh.scale.y = Math.sign(theta);
    arc.add(mesh);
  }

  // The labels of what moves; those of a and alpha stand still and come from Python.
  function dhLabels(row, i) {
    const write = (label, text) => {
      if (label.text !== text) label.div.innerHTML = label.text = text;
    };
    const at = { path: row.path, group: `dh${i}`, at: [0, 0, 0] };
    return [
      {
        ...at,
        update(label, q) {
          const { theta } = dhValues(row, q);
          const far = 1.15 * row.radius;
          label.at = [far * Math.cos(theta / 2), far * Math.sin(theta / 2), 0];
          write(label, `<b class="z">θ<sub>${row.name}</sub> = ${degrees(theta)}</b>`);
        },
      },
      {
        ...at,
        update(label, q) {
          const { d } = dhValues(row, q);
          label.at = [0, 0, d / 2];
          const text = `<b class="z">d<sub>${row.name}</sub> = ${metres(d)}</b>`;
          write(label, metres(d) === "0" ? "" : text);
        },
      },
    ];
  }

  // Velocity ellipsoid: semi-axes sigma_i; force ellipsoid: 1/sigma_i, along the same vectors,
  // each scaled to fit. Directions beyond `rank` (out of a planar arm's plane) are drawn flat.
  function drawEllipsoid(entry, linear, at) {
    const axes = svd(linear);
    const longest = axes[0].sigma || 1;
    const least = Math.max(axes[entry.rank - 1].sigma, 1e-9 * longest);
    const radius = axes.map(({ sigma }, i) => {
      if (i >= entry.rank) return 0.01 * entry.size;
      const ratio = entry.kind === "velocity" ? sigma / longest : least / Math.max(sigma, least);
      return entry.size * Math.max(ratio, 0.01);
    });
    const [x, y] = [axes[0].vector, axes[1].vector];
    const z = cross(x, y);
    const [a, b, c] = radius;
    const T = [0, 1, 2].flatMap((r) => [a * x[r], b * y[r], c * z[r], at[r]]);
    place(entry.path, [...T, 0, 0, 0, 1]);
  }

  // meshcat merges the parts of a Collada file and gives each part one slot for its material; a
  // part that has several materials itself would stay invisible. It gets the first of them.
  function mendMaterials(root) {
    root.traverse((object) => {
      if (!Array.isArray(object.material)) return;
      object.material = object.material.map((material) => [material].flat()[0]);
    });
  }

  // A mesh file may leave out its normals, or give zeros for them, which no light falls on.
  function mendNormals(root) {
    root.traverse(({ geometry }) => {
      const normal = geometry && geometry.attributes && geometry.attributes.normal;
      if (!normal) return;
      for (let i = 0; i < normal.count; i++) {
        if (Math.hypot(normal.getX(i), normal.getY(i), normal.getZ(i)) > 1e-6) continue;
        geometry.computeVertexNormals();
        return;
      }
    });
  }

  // Frames are seen through the bodies they are in.
  function bringForward(path) {
    node(path).traverse((object) => {
      if (!object.material) return;
      object.renderOrder = 1;
      object.material.depthTest = false;
      object.material.transparent = true; // drawn after all that is solid
    });
  }

  // Fades the arm's bodies, so that lines inside them can be seen.
  const asLoaded = new WeakMap();
  function setOpacity(path, opacity) {
    const fade = (material) => {
      const { opacity: full, transparent } = material;
      if (!asLoaded.has(material)) asLoaded.set(material, { full, transparent });
      const own = asLoaded.get(material);
      material.opacity = own.full * opacity;
      material.transparent = opacity < 1 || own.transparent;
      material.depthWrite = opacity === 1;
    };
    node(path).traverse((group) => {
      if (group.name !== "visuals") return;
      group.traverse((object) => [object.material || []].flat().forEach(fade));
    });
  }

  // ---- the page ------------------------------------------------------------------------

  function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) {
      if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
      else if (key === "html") made.innerHTML = value;
      else made.setAttribute(key, value);
    }
    made.append(...children);
    return made;
  }

  const isTurn = (joint) => joint.type !== "prismatic";
  const shown = (joint, value) => (isTurn(joint) ? (value * 180) / Math.PI : value * 1000);
  const meant = (joint, value) => (isTurn(joint) ? (value * Math.PI) / 180 : value / 1000);
  const unit = (joint) => (isTurn(joint) ? "°" : "mm");

  // Roll, pitch, yaw in degrees: R = Rz(yaw) Ry(pitch) Rx(roll), as in a URDF.
  function angles(T) {
    const pitch = Math.atan2(-T[8], Math.hypot(T[0], T[4]));
    const [roll, yaw] = [Math.atan2(T[9], T[10]), Math.atan2(T[4], T[0])];
    return [roll, pitch, yaw].map((a) => (a * 180) / Math.PI);
  }

  function start(spec) {
    words = spec.words || {};
    const model = spec.kind === "fivebar" ? fiveBar(spec) : serialArm(spec);
    const state = { q: spec.q.slice(), row: "", time: 0, playing: false, last: null };
    const active = new Set(spec.shown);
    const panel = document.getElementById("panel");
    const overlay = document.getElementById("labels");
    const sliders = [];
    const report = {};
    const boxes = {};
    const trace = [];

    function setJoints(wanted, { tell = true } = {}) {
      const { q, stopped } = model.admit(state.q, wanted);
      state.q = q;
      model.place(q);
      sliders.forEach(({ range, box }, i) => {
        range.value = q[i];
        if (document.activeElement !== box) box.value = fixed(shown(model.joints[i], q[i]), 1);
      });
      report.stopped.textContent = stopped;
      report.stopped.hidden = !stopped;
      showNumbers();
      if (tell && api.onjoints) api.onjoints(q);
      return q;
    }

    function showNumbers() {
      const T = model.tool(state.q);
      const at = origin(T);
      const { sigmaMin, kappa, det } = metrics(model.task(state.q));
      const coordinates = spec.planar ? at.slice(0, 2) : at;
      report.position.textContent = coordinates.map((x) => fixed(x, 4)).join("  ");
      report.angles.textContent = angles(T).map((x) => fixed(x, 1)).join("  ");
      report.det.textContent = det === null ? _("J is not square") : number(det);
      report.sigma.textContent = number(sigmaMin);
      report.kappa.textContent = number(kappa);
      for (const entry of spec.ellipsoids) drawEllipsoid(entry, model.linear(state.q), at);
      if (active.has("trace")) {
        trace.push(at);
        if (trace.length > 2000) trace.shift();
        drawTrace();
      }
      for (const [i, row] of spec.dh.entries()) {
        const { theta, d } = dhValues(row, state.q);
        report.dh[i].theta.textContent = degrees(theta);
        report.dh[i].d.textContent = metres(d);
      }
    }

    function drawTrace() {
      const holder = node(spec.trace);
      if (!holder.children.length) {
        const line = new THREE.Line(
          new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xd81b60 }));
        line.frustumCulled = false;
        holder.add(line);
      }
      const line = holder.children[0];
      line.geometry.dispose(); // or every frame would leave its points on the graphics card
      line.geometry = new THREE.BufferGeometry();
      const points = new THREE.Float32BufferAttribute(trace.flat(), 3);
      line.geometry.setAttribute("position", points);
    }

    // -- groups of nodes and labels that are shown or hidden together

    function show(group, on) {
      if (on) active.add(group);
      else active.delete(group);
      if (boxes[group]) boxes[group].checked = on;
      const seen = new Set([...active].flatMap((name) => spec.groups[name] || []));
      for (const path of Object.values(spec.groups).flat()) node(path).visible = seen.has(path);
      if (group === "trace") {
        trace.length = 0;
        showNumbers();
      }
      const bare = [...active].some((name) => name.startsWith("dh"));
      if (spec.body) setOpacity(spec.body, bare ? 0.25 : 1);
      viewer.set_dirty();
    }

    function showRow(chosen) {
      state.row = state.row === chosen ? "" : chosen;
      spec.dh.forEach((_, i) => {
        const on = state.row === "all" || state.row === String(i);
        show(`dh${i}`, on);
        report.dh[i].line.classList.toggle("chosen", on);
      });
    }

    const labels = spec.labels.concat(spec.dh.flatMap(dhLabels)).map((label) => {
      const div = element("div", { class: `label ${label.group}`, html: label.html || "" });
      overlay.append(div);
      return { ...label, div };
    });

    // Puts every shown label at its point; where two would overlap, the later one moves aside.
    function layLabels() {
      const [width, height] = [overlay.clientWidth, overlay.clientHeight];
      const taken = [];
      for (const label of labels) {
        const groups = label.group.split(" ");
        const visible = groups.some((group) => active.has(group));
        label.div.hidden = !visible;
        if (!visible) continue;
        if (label.update) label.update(label, state.q);
        const at = new THREE.Vector3(...label.at);
        const p = at.applyMatrix4(node(label.path).matrixWorld).project(viewer.camera);
        if (p.z > 1 || Math.abs(p.x) > 1.2 || Math.abs(p.y) > 1.2) {
          label.div.hidden = true;
          continue;
        }
        const w = label.div.offsetWidth, h = label.div.offsetHeight;
        const x0 = ((p.x + 1) / 2) * width + 6, y0 = ((1 - p.y) / 2) * height - h - 2;
        const spot = [[0, 0], [0, h], [0, -h], [-w - 12, 0], [-w - 12, h], [0, 2 * h], [0, -2 * h],
          [-w - 12, -h], [0, 3 * h], [0, -3 * h], [-w - 12, 2 * h], [0, 4 * h]]
          .map(([dx, dy]) => [x0 + dx, y0 + dy])
          .find(([x, y]) => !taken.some((b) =>
            x < b[0] + b[2] && b[0] < x + w && y < b[1] + b[3] && b[1] < y + h)) || [x0, y0];
        taken.push([...spot, w, h]);
        label.div.style.transform = `translate(${spot[0]}px, ${spot[1]}px)`;
      }
    }

    // -- animation: joint positions at given times, straight lines between them

    function seek(time) {
      const { times, q } = spec.animation;
      state.time = Math.min(Math.max(time, 0), times[times.length - 1]);
      let k = times.findIndex((t) => t >= state.time);
      if (k < 1) k = 1;
      const f = (state.time - times[k - 1]) / (times[k] - times[k - 1]);
      setJoints(q[k].map((x, i) => q[k - 1][i] + f * (x - q[k - 1][i])));
      report.scrub.value = state.time;
      report.clock.textContent = `${state.time.toFixed(2)} s`;
    }

    function play(on) {
      state.playing = on;
      state.last = null;
      report.play.textContent = on ? _("Pause") : _("Play");
    }

    function everyFrame(now) {
      if (state.playing) {
        const step = state.last === null ? 0 : (now - state.last) / 1000;
        const end = spec.animation.times[spec.animation.times.length - 1];
        state.last = now;
        seek(state.time + step > end ? 0 : state.time + step);
      }
      layLabels();
      requestAnimationFrame(everyFrame);
    }

    // -- the panel

    function line(name, key, title) {
      report[key] = element("span", { class: "value" });
      return element("div", { class: "line", title }, element("span", { html: name }), report[key]);
    }

    function slider(joint, i) {
      const step = "any";
      const range = element("input", { type: "range", min: joint.lower, max: joint.upper, step,
        "aria-label": joint.name });
      const box = element("input", { type: "number", step, "aria-label": fill(_("{name} value"), joint) });
      const move = (value) => {
        stopPlaying();
        setJoints(state.q.map((x, k) => (k === i ? value : x)));
      };
      range.addEventListener("input", () => move(Number(range.value)));
      box.addEventListener("change", () => {
        const value = meant(joint, Number(box.value));
        move(Math.min(joint.upper, Math.max(joint.lower, value)));
      });
      range.disabled = box.disabled = joint.lower === joint.upper;
      sliders.push({ range, box });
      return element("div", { class: "joint" },
        element("span", { class: "name", title: joint.name }, joint.label), range, box,
        element("span", { class: "unit" }, unit(joint)));
    }

    const stopPlaying = () => spec.animation && play(false);

    function check(group, text) {
      const box = element("input", { type: "checkbox",
        onchange: (event) => show(group, event.target.checked) });
      boxes[group] = box;
      return element("label", { class: "check" }, box, text);
    }

    function dhTable() {
      report.dh = spec.dh.map((row, i) => {
        const [theta, d] = [element("td"), element("td")];
        const still = [row.name, metres(row.a), degrees(row.alpha)];
        const cells = still.map((x) => element("td", {}, x));
        const tr = element("tr", { onclick: () => showRow(String(i)) }, ...cells, d, theta);
        return { line: tr, theta, d };
      });
      if (!spec.dh.length) return [];
      const head = ["i", ...spec.dh_columns].map((x) => element("th", { html: x }));
      return [
        element("h2", {}, fill(_("DH table, {convention}"), { convention: spec.dh_convention })),
        element("table", {}, element("tr", {}, ...head), ...report.dh.map((r) => r.line)),
        element("button", { onclick: () => showRow("all"), id: "dh-all" }, _("Draw all rows")),
        element("small", {}, _("or click a row. Lengths in m.")),
      ];
    }

    function animationPanel() {
      if (!spec.animation) return [];
      const end = spec.animation.times[spec.animation.times.length - 1];
      report.play = element("button", { id: "play", onclick: () => play(!state.playing) },
        _("Play"));
      report.scrub = element("input", { type: "range", id: "scrub", min: 0, max: end, step: "any",
        value: 0, "aria-label": _("time"), oninput: (event) => {
          play(false);
          seek(Number(event.target.value));
        } });
      report.clock = element("span", { class: "unit" }, "0.00 s");
      return [element("h2", {}, spec.animation.name),
        element("div", { class: "joint" }, report.play, report.scrub, report.clock)];
    }

    function poseButton(name, q) {
      return element("button", { onclick: () => { stopPlaying(); setJoints(q); } }, name);
    }

    function legend({ name, low, high, color }) {
      if (color) {
        return element("div", { class: "line" }, element("span", {}, name),
          element("span", { class: "swatch", style: `background: ${color}` }));
      }
      return element("div", { class: "line legend" }, element("span", {}, name),
        element("span", {}, number(low, 2), element("i"), number(high, 2)));
    }

    // -- a live page tells its server where the sliders stand, and draws what the script adds

    function connect() {
      const address = new URL("socket", location);
      address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
      const socket = new WebSocket(address);
      let early = null;  // where the sliders were moved to before the server could be told
      socket.binaryType = "arraybuffer";
      socket.onopen = () => early && socket.send(JSON.stringify({ q: early }));
      socket.onmessage = ({ data }) => {
        if (data instanceof ArrayBuffer) {
          viewer.handle_command_bytearray(new Uint8Array(data));
          return;
        }
        const { q, reload, revision } = JSON.parse(data);
        if (q) setJoints(q, { tell: false });
        if (reload || (revision !== undefined && revision !== spec.live)) location.reload();
      };
      socket.onclose = () => {
        report.ended.hidden = false;
      };
      api.onjoints = (q) => {
        if (socket.readyState === WebSocket.CONNECTING) early = q;
        else if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify({ q }));
      };
    }

    report.ended = element("div", { class: "warning", id: "ended" },
      _("The server has ended. The sliders still work; reload when it is back."));
    report.ended.hidden = true;
    const turns = line(_("roll, pitch, yaw [°]"), "angles", "R = Rz(yaw) Ry(pitch) Rx(roll)");
    report.stopped = element("div", { class: "warning", id: "stopped" });
    report.stopped.hidden = true;
    panel.append(
      element("h1", {}, spec.title),
      element("small", { class: "subtitle", title: spec.subtitle,
        onclick: (event) => event.target.classList.toggle("whole") }, spec.subtitle),
      report.ended,
      ...spec.notes.map((text) => element("div", { class: "warning" }, text)),
      ...animationPanel(),
      element("h2", {}, _("Joints")),
      element("div", { id: "joints" }, ...model.joints.map(slider)),
      report.stopped,
      element("div", { class: "buttons" },
        ...Object.entries(spec.poses).map(([name, q]) => poseButton(name, q))),
      element("h2", {}, _("Tool")),
      line(`x, y${spec.planar ? "" : ", z"} [m]`, "position",
        _("position of the tool in the base")),
      spec.planar ? "" : turns,
      element("h2", {}, fill(_("Jacobian, {task}"), spec)),
      line("det J", "det", _("determinant of the Jacobian's task rows")),
      line("σ<sub>min</sub>", "sigma", _("smallest singular value: 0 in a singular pose")),
      line("κ = σ<sub>max</sub>/σ<sub>min</sub>", "kappa", _("condition number: 1 if isotropic")),
      element("h2", {}, _("Show")),
      ...spec.checks.map(([group, text]) => check(group, text)),
      ...spec.legend.map(legend),
      ...dhTable(),
    );
    mendMaterials(viewer.scene);
    mendNormals(viewer.scene);
    for (const path of spec.groups.frames || []) bringForward(path);
    for (const group of spec.shown) show(group, true);

    // meshcat takes the window's height for the picture's
    const resize = viewer.set_3d_pane_size.bind(viewer);
    viewer.set_3d_pane_size = (width, height = viewer.dom_element.offsetHeight) =>
      resize(width, height);
    viewer.set_3d_pane_size();
    // the field of view is the height's; in a narrow picture the width must hold everything
    const target = spec.camera.target, back = Math.max(1, 1 / viewer.camera.aspect);
    const [x, y, z] = spec.camera.position.map((p, i) => target[i] + back * (p - target[i]));
    viewer.camera.fov = spec.camera.fov;
    viewer.camera.position.set(x, z, -y); // meshcat's world is z up, three.js is y up
    viewer.controls.target.set(target[0], target[2], -target[1]);
    const api = {
      spec, model, state, setJoints, seek, play, show, showRow, onjoints: null,
      get q() { return state.q.slice(); },
    };
    setJoints(state.q, { tell: false });
    if (spec.animation) seek(0);
    if (spec.live) connect();
    requestAnimationFrame(everyFrame);
    return api;
  }

  return {
    multiply, jointMotion, svd, determinant, metrics, serialArm, fiveBar, place, node, start,
  };
})();
