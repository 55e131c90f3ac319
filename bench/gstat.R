# Kriging of the three components with the 50 nearest fingerprints: what users of R do today. Arguments: the folder that
# field_map_part made. Writes means and variances of the cells and the CPU seconds of the three predictions.
suppressPackageStartupMessages({library(sp); library(gstat)})
folder <- commandArgs(trailingOnly = TRUE)[1]
model <- read.csv(file.path(folder, "model.csv"))
samples <- read.csv(file.path(folder, "samples.csv"))
cells <- read.csv(file.path(folder, "cells.csv"))
coordinates(samples) <- ~x + y
coordinates(cells) <- ~x + y
# gstat's "Gau" is exp(-(h / range)^2); noise is a measurement error, no part of the field.
variogram <- vgm(model$noise_sd^2, "Err", 0, add.to = vgm(model$signal_sd^2, "Gau", sqrt(2) * model$length_scale_m))
result <- data.frame(x = coordinates(cells)[, 1], y = coordinates(cells)[, 2])
before <- proc.time()
for (component in c("bx", "by", "bz")) {
  kriged <- krige(as.formula(paste(component, "~ 1")), samples, cells, model = variogram, beta = 0, nmax = 50,
                  debug.level = 0)
  result[[component]] <- kriged$var1.pred
  result[[paste0(component, "_variance")]] <- kriged$var1.var
}
spent <- proc.time() - before
write.csv(result, file.path(folder, "gstat.csv"), row.names = FALSE)
writeLines(format(spent[["user.self"]] + spent[["sys.self"]], digits = 6), file.path(folder, "gstat_cpu_s.txt"))
