//! What happens at one collision: probabilities, energies and moments of the particle models.
