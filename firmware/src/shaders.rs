//! Every shading method, for boards with flash for all of them.

use embedded_graphics::pixelcolor::Gray8;
use microphong::{Shader, pixel::Pixel};
use microphong_literature::ALL;

/// All methods: first the core's, then the literature's.
struct Every<C>(core::marker::PhantomData<C>);

impl<C: Pixel> Every<C> {
    const OWN: usize = Shader::<C>::ALL.len();
    const SHADERS: [Shader<C>; Shader::<Gray8>::ALL.len() + ALL.len()] = {
        let mut shaders = [Shader::FLAT; Shader::<Gray8>::ALL.len() + ALL.len()];
        let mut i = 0;
        while i < shaders.len() {
            shaders[i] = if i < Self::OWN { Shader::<C>::ALL[i] } else { Shader::new(ALL[i - Self::OWN]) };
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
