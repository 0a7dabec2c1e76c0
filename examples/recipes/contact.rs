// A sphere that meets a wall, in Rust: the springs of contactlab's kernel in single precision.
//
//     contactlab kernel --out build
//     gcc -O2 -c -I build -DCONTACTLAB_REAL=float contact.c -o build/contact.o
//     rustc -O contact.rs -C link-arg=build/contact.o -o contact && ./contact
//
// `contact.c` gives the kernel, which is inline, a name to link. The program prints psi1 and psi2.

const SPRINGS: usize = 8;
const STATE: usize = 2 + 3 * SPRINGS;

extern "C" {
    fn contact_step(
        state: *mut f32, springs: i32, moved: *const f32, normal: *const f32, radius: f32, limit: f32,
        unit: f32, modulus: f32, force: *mut f32,
    ) -> f32;
}

/// The friction of one contact. All zero is no contact.
struct Contact([f32; STATE]);

impl Contact {
    /// Returns the friction on the first body, in N, and the friction work, in J.
    fn step(&mut self, moved: [f32; 3], normal: [f32; 3], radius: f32, limit: f32, unit: f32, modulus: f32) -> ([f32; 3], f32) {
        let mut force = [0.0; 3];
        let work = unsafe {
            contact_step(self.0.as_mut_ptr(), SPRINGS as i32, moved.as_ptr(), normal.as_ptr(), radius, limit,
                unit, modulus, force.as_mut_ptr())
        };
        (force, work)
    }

    /// Turns the springs by an angle about the normal: the mean of both bodies' spins times the step.
    fn turn(&mut self, n: [f32; 3], angle: f32) {
        let (s, c) = angle.sin_cos();
        for w in self.0[2..].chunks_exact_mut(3) {
            let (x, y, z) = (w[0], w[1], w[2]);
            w[0] = c * x + s * (n[1] * z - n[2] * y);
            w[1] = c * y + s * (n[2] * x - n[0] * z);
            w[2] = c * z + s * (n[0] * y - n[1] * x);
        }
    }
}

fn main() {
    let (radius, mass, modulus, poisson, friction) = (0.01_f64, 0.01_f64, 60e9_f64, 0.3_f64, 0.2_f64);
    let (elastic, shear) = (modulus / 2.0 / (1.0 - poisson * poisson), modulus / 2.0 / (1.0 + poisson));
    let (speed, spin, step) = (0.1, 3.0, 2e-7);
    let scale = 2.0 * (1.0 - poisson) / (2.0 - poisson) / (friction * speed);
    for degrees in (5..60).step_by(5) {
        let (mut overlap, mut approach) = (0.0, speed);
        let first = speed * f64::from(degrees).to_radians().tan();
        let mut slip = first;
        let mut contact = Contact([0.0; STATE]);
        loop {
            overlap += step * approach;
            if overlap <= 0.0 {
                break;
            }
            // The wall lies below, the normal leads down to it, and the ball slips along x.
            let normal = [0.0, 0.0, -1.0];
            contact.turn(normal, (-0.5 * spin * step) as f32);
            let touch = (radius * overlap).sqrt();
            let load = 4.0 / 3.0 * elastic * touch * overlap;
            let (force, _) = contact.step(
                [(slip * step) as f32, 0.0, 0.0], normal, touch as f32, (friction * load) as f32,
                radius as f32, (4.0 * shear / (2.0 - poisson)) as f32,
            );
            approach -= step * load / mass;
            slip += step * 3.5 * f64::from(force[0]) / mass;
        }
        println!("{degrees} {:.4} {:.4}", first * scale, slip * scale);
    }
}
