    } else if (cfg.analytic_model == "partial_slip") {
        // oblique impacts of solid spheres (tags 1, 2, ...) on a wall of their material with
        // normal +z, from stick through partial slip to gross slip.  With approach velocities
        // (vx_in_<tag>, 0, -vz_in), no spin and poisson = 0.3, the velocity of the contact point
        // in units of mu vz_in / kappa, kappa = 2 (1 - poisson) / (2 - poisson), is psi1 before
        // and psi2 after the impact:
        //   vz_out = en vz_in,  vx_out = vx_in + (psi2 - psi1) mu vz_in / (3.5 kappa),
        //   omega_y_out = (5/2) (vx_in - vx_out) / r.
        // psi2 is linear between the points below, to 0.002.  For en = 1 it is the solution of
        // Maw et al, Wear 38 (1976) 101-114; for en = 0.9 the damping of tsuji or
        // coeff_restitution is shared by pressure and shear (xt = NULL of mindlin_springs).
        // From the last point on, in gross slip, psi2 - psi1 stays: this is oblique_impact.
        // Evaluate at a free-flight segment after the rebound.
        using Points = std::vector<std::pair<double, double>>;
        static const Points elastic = {
            {0.000, 0.000},  {0.175, 0.033},  {0.342, 0.048},  {0.501, 0.048},  {0.658, 0.031},
            {0.814, -0.001}, {0.974, -0.050}, {1.049, -0.083}, {1.148, -0.143}, {1.284, -0.246},
            {1.803, -0.684}, {2.024, -0.855}, {2.228, -0.998}, {2.423, -1.119}, {2.615, -1.222},
            {2.803, -1.308}, {2.987, -1.376}, {3.169, -1.427}, {3.346, -1.461}, {3.519, -1.479},
            {3.685, -1.480}, {3.846, -1.466}, {4.001, -1.436}, {4.149, -1.393}, {4.288, -1.336},
            {4.420, -1.267}, {4.544, -1.187}, {4.659, -1.098}, {4.765, -1.000}};
        static const Points damped = {
            {0.000, 0.000},  {0.214, 0.013},  {0.422, 0.009},  {0.619, -0.009}, {0.811, -0.043},
            {1.002, -0.093}, {1.101, -0.130}, {1.221, -0.193}, {1.380, -0.295}, {1.933, -0.689},
            {2.158, -0.836}, {2.366, -0.958}, {2.563, -1.059}, {2.749, -1.140}, {2.935, -1.206},
            {3.116, -1.255}, {3.291, -1.289}, {3.461, -1.305}, {3.625, -1.307}, {3.779, -1.293},
            {3.921, -1.266}, {4.058, -1.226}, {4.190, -1.172}, {4.310, -1.109}, {4.420, -1.036},
            {4.518, -0.957}, {5.476, 0.000}};
        const double vz = var_or(vars, "vz_in", 0.0);
        const double en = var_or(vars, "en", 1.0);
        const double mu = var_or(vars, "xmu", 0.0);
        const double nu = var_or(vars, "poisson", 0.0);
        const double r  = var_or(vars, "radius", 0.0);
        ASSERT_TRUE((nu == 0.3) && ((en == 1.0) || (en == 0.9)))
            << "partial_slip: no points for poisson " << nu << " and en " << en;
        const Points &points = (en == 1.0) ? elastic : damped;
        const double unit    = mu * vz * (2.0 - nu) / (2.0 * (1.0 - nu));
        for (tagint tag = 1; tag <= lmp->atom->natoms; ++tag) {
            const std::string id = std::to_string(tag);
            const double vx      = var_or(vars, "vx_in_" + id, 0.0);
            const int i          = find_local(lmp, tag);
            ASSERT_GE(i, 0) << "partial_slip: atom with tag " << id << " not found";
            const double psi1 = vx / unit;
            double change     = points.back().second - points.back().first;
            for (std::size_t k = 1; k < points.size(); ++k) {
                if (psi1 > points[k].first) continue;
                const auto &low   = points[k - 1];
                const auto &high  = points[k];
                const double part = (psi1 - low.first) / (high.first - low.first);
                change = low.second + part * (high.second - low.second) - psi1;
                break;
            }
            const double dvt = -change * unit / 3.5;    // tangential velocity decrement
            const double tol = cfg.analytic_tol;
            expect_rel(en * vz, lmp->atom->v[i][2], tol, "partial_slip vz_out " + id);
            expect_rel(vx - dvt, lmp->atom->v[i][0], tol, "partial_slip vx_out " + id);
            expect_rel(2.5 * dvt / r, lmp->atom->omega[i][1], tol, "partial_slip omega_y " + id);
        }
