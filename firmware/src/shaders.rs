//! Every shading method, for boards with flash for all of them.

use microphong::{Shader, pixel::Pixel};
use microphong_literature::ALL;

/// Those of the core, then those of the literature.
struct Every<C>(core::marker::PhantomData<C>);

impl<C: Pixel> Every<C> {
    const SHADERS: [Shader<C>; 26] = {
        let [a, b, c, d, e, f] = Shader::ALL;
        let mut shaders = [a; 26];
        (shaders[1], shaders[2], shaders[3], shaders[4], shaders[5]) = (b, c, d, e, f);
        let mut i = 0;
        while i < ALL.len() {
            shaders[6 + i] = Shader::new(ALL[i]);
            i += 1;
        }
        shaders
    };
}

/// Every method in a pixel format.
#[must_use]
pub const fn every<C: Pixel>() -> &'static [Shader<C>] {
    &Every::<C>::SHADERS
}
